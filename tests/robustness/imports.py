#!/usr/bin/env python3
"""Nacre: damaged files of the formats that VTK and GDCM read in child processes. Usage: imports.py PROGRAM RUNS FOUND

Each run damages one of a few small inputs, or what a child reports about one, and gives it to `nacre info`. A child may
crash, or be ended after its 120 s; the program may not: good is status 0, or 1 and one line that begins "nacre:",
without a report of a sanitizer, within 200 s, with nothing left in the folder for temporary files. Run number n is the same each time. The inputs of bad
runs are kept in FOUND; then the status is 1.
"""
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile

NUMBERS = [b"0", b"-1", b"1", b"255", b"65536", b"2147483647", b"-2147483648", b"4294967295", b"9223372036854775807",
           b"18446744073709551616", b"1e308", b"-1e39", b"1e-320", b"nan", b"inf", b"0x10", b"1,5"]


def legacy(content):
    return f"# vtk DataFile Version 3.0\na\nASCII\nDATASET {content}".encode()


def xml(kind, extent, content):
    return (f'<VTKFile type="{kind}" version="0.1" byte_order="LittleEndian"><{kind} WholeExtent="{extent}"><Piece '
            f'Extent="{extent}">{content}</Piece></{kind}></VTKFile>').encode()


def array(name, numbers, components=1):
    return (f'<DataArray type="Float32" Name="{name}" NumberOfComponents="{components}" format="ascii">{numbers}'
            "</DataArray>")


def dicom(number):
    """A CT image of 4 x 4 pixels, explicit little endian."""
    def element(group, item, kind, value):
        value = value if isinstance(value, bytes) else str(value).encode()
        value += (b"\0" if kind in (b"UI", b"OW") else b" ") * (len(value) % 2)
        size = struct.pack("<HI", 0, len(value)) if kind == b"OW" else struct.pack("<H", len(value))
        return struct.pack("<HH", group, item) + kind + size + value

    ct, syntax = "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.1.2.1"
    meta = element(2, 2, b"UI", ct) + element(2, 3, b"UI", f"1.2.3.{number}") + element(2, 0x10, b"UI", syntax)
    short = lambda value: struct.pack("<H", value)
    body = [(8, 0x16, b"UI", ct), (8, 0x18, b"UI", f"1.2.3.{number}"), (8, 0x60, b"CS", "CT"),
            (0x18, 0x50, b"DS", "2"), (0x20, 0xd, b"UI", "1.2.4"), (0x20, 0xe, b"UI", "1.2.5"),
            (0x20, 0x13, b"IS", number), (0x20, 0x32, b"DS", f"0\\0\\{2 * number}"),
            (0x20, 0x37, b"DS", "1\\0\\0\\0\\1\\0"), (0x28, 2, b"US", short(1)), (0x28, 4, b"CS", "MONOCHROME2"),
            (0x28, 0x10, b"US", short(4)), (0x28, 0x11, b"US", short(4)), (0x28, 0x30, b"DS", "0.5\\0.5"),
            (0x28, 0x100, b"US", short(16)), (0x28, 0x101, b"US", short(16)), (0x28, 0x102, b"US", short(15)),
            (0x28, 0x103, b"US", short(0)), (0x28, 0x1052, b"DS", "-512"), (0x28, 0x1053, b"DS", "1"),
            (0x7fe0, 0x10, b"OW", bytes(range(32)))]
    return (bytes(128) + b"DICM" + element(2, 0, b"UL", struct.pack("<I", len(meta))) + meta +
            b"".join(element(*each) for each in body))


def foam(kind, content):
    return f"FoamFile\n{{\n version 2.0;\n format ascii;\n class {kind};\n object a;\n}}\n{content}\n".encode()


def inputs():
    """Per input: the file or folder that is opened, and all of its files."""
    corners = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1"
    yield "cube.vtk", {"cube.vtk": legacy(
        f"UNSTRUCTURED_GRID\nPOINTS 8 float\n{corners}\nCELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 0 1 3 4\nCELL_TYPES 2\n12\n10\n"
        "POINT_DATA 8\nVECTORS v float\n" + corners + "\nCELL_DATA 2\nSCALARS p float 1\nLOOKUP_TABLE default\n7 8\n")}
    yield "faces.vtk", {"faces.vtk": legacy(
        f"POLYDATA\nPOINTS 8 float\n{corners}\nPOLYGONS 2 9\n3 0 1 2\n4 4 5 6 7\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n"
        "CELL_DATA 3\nFIELD f 1\na 2 3 double\n1 2 3 4 5 6\n")}
    yield "image.vtk", {"image.vtk": legacy(
        "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 2\nPOINT_DATA 8\nSCALARS a short 1\n"
        "LOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n")}
    values = "<PointData>" + array("p", "1 2 3 4 5 6 7 8") + "</PointData>"
    grid = xml("StructuredGrid", "0 1 0 1 0 1", values + f"<Points>{array('x', corners, 3)}</Points>")
    yield "grid.vts", {"grid.vts": grid}
    axis = array("x", "0 1")
    yield "grid.vtr", {"grid.vtr": xml("RectilinearGrid", "0 1 0 1 0 1",
                                       f"{values}<Coordinates>{axis}{axis}{axis}</Coordinates>")}
    yield "both.vtm", {"grid.vts": grid, "both.vtm": b'<VTKFile type="vtkMultiBlockDataSet" version="1.0">'
                       b'<vtkMultiBlockDataSet><Block index="0" name="hull"><DataSet index="0" file="grid.vts"/></Block>'
                       b'<DataSet index="1" file="grid.vts"/></vtkMultiBlockDataSet></VTKFile>'}
    column = lambda numbers: "".join(f"{x:12.5e}\n" for x in numbers)
    yield "run.case", {
        "run.case": b"FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: mesh.geo\nVARIABLE\nscalar per node: 1 p p.*\nTIME\n"
                    b"time set: 1\nnumber of steps: 2\nfilename start number: 0\nfilename increment: 1\ntime values: 0 1\n",
        "mesh.geo": ("a\nb\nnode id off\nelement id off\npart\n         1\nc\ncoordinates\n         4\n" +
                     column([0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0]) +
                     "quad4\n         1\n         1         2         3         4\n").encode(),
        **{f"p.{k}": ("x\npart\n         1\ncoordinates\n" + column(range(4))).encode() for k in range(2)}}
    mesh = "constant/polyMesh/"
    corner_list = "\n".join("(" + " ".join(corners.split()[3 * k:3 * k + 3]) + ")" for k in range(8))
    yield "run.foam", {
        "run.foam": b"", "system/controlDict": foam("dictionary", "startFrom latestTime;\nstartTime 0;\nendTime 1;\n"
                                                    "deltaT 1;\nwriteControl timeStep;\nwriteInterval 1;"),
        mesh + "points": foam("vectorField", f"8\n(\n{corner_list}\n)"),
        mesh + "faces": foam("faceList", "6\n(\n4(0 3 2 1)\n4(4 5 6 7)\n4(0 1 5 4)\n4(1 2 6 5)\n4(2 3 7 6)\n4(3 0 4 7)\n)"),
        mesh + "owner": foam("labelList", "6\n(\n0\n0\n0\n0\n0\n0\n)"),
        mesh + "neighbour": foam("labelList", "0\n(\n)"),
        mesh + "boundary": foam("polyBoundaryMesh", "2\n(\nfloor\n{\n type wall;\n inGroups 1(wall);\n nFaces 1;\n "
                                "startFace 0;\n}\nrest\n{\n type patch;\n nFaces 5;\n startFace 1;\n}\n)"),
        "0/U": foam("volVectorField", "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 0);\nboundaryField\n{\n"
                    "floor\n{\n type fixedValue;\n value uniform (1 2 3);\n}\nrest\n{\n type zeroGradient;\n}\n}")}
    yield "scan", {f"scan/IM{k}": dicom(k) for k in range(3)}
    beside = pathlib.Path(__file__).resolve().parents[3] / "shared/data/flow/disk-out"
    for name in ("SurfaceVectors.vtk", "disk_out_ref.ex2"):
        if (beside / name).is_file():
            yield name, {name: (beside / name).read_bytes()}


def damaged(chance, content, other):
    content = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 4, 8))):
        at = chance.randrange(len(content) + 1)
        span = slice(at, at + chance.choice((1, 2, 4, 8, 32, 200)))
        numbers = list(re.finditer(rb"-?\d+(\.\d+)?(e[-+]?\d+)?", bytes(content[:100000])))
        kind = chance.randrange(7)
        if kind <= 1 and numbers:
            number = chance.choice(numbers)
            content[number.start():number.end()] = chance.choice(NUMBERS)
        elif kind == 2:
            content[span] = chance.randbytes(len(content[span]))
        elif kind == 3:
            del content[span]
        elif kind == 4:
            content[at:at] = content[span]
        elif kind == 5:
            content[at:at] = other[span] or other[-8:]
        elif chance.randrange(4) == 0:
            del content[at:]
    return bytes(content)


# A child that reports two steps of a triangle, and a part.
TRIANGLE = ('<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="3" '
            'NumberOfPolys="1"><Points>' + array("x", "0 0 0 1 0 0 0 1 0", 3) + '</Points><Polys><DataArray type="Int32" '
            'Name="connectivity" format="ascii">0 1 2</DataArray><DataArray type="Int32" Name="offsets" format="ascii">3'
            "</DataArray></Polys></Piece></PolyData></VTKFile>").encode()
REPORT = b"part hull\n0 FOLDER/step_0.vtp\n0.5 FOLDER/step_1.vtp\n"
CHILD = """#!/bin/sh
here=$(dirname "$0")
for folder; do :; done
cp "$here/triangle" "$folder/step_0.vtp"; cp "$here/triangle" "$folder/step_1.vtp"
sed "s,FOLDER,$folder,g" "$here/report"
"""


def write(folder, files):
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


def why_bad(status, errors, left):
    lines = [line for line in errors.splitlines() if line.startswith("nacre:")]
    if re.search("^(?!nacre:).*(Sanitizer|runtime error:)", errors, re.MULTILINE):  # not one of the child's, quoted
        return "report of a sanitizer"
    if status not in (0, 1):
        return f"status {status}"
    if status == 1 and len(lines) != 1:
        return f"failed with {len(lines)} lines that begin 'nacre:'"
    return "files left" if left else None


def run(program, number, work):
    """Why run `number` was bad, and what the program said. Its input is in `work`."""
    chance = random.Random(number)
    every = list(inputs())
    opened, files = chance.choice(every)
    environment = dict(os.environ, TMPDIR=str(work / "temporary"), OMP_NUM_THREADS="1")
    (work / "temporary").mkdir(parents=True)
    if chance.randrange(5) == 0:
        child = work / "child"
        write(child, {"child.sh": CHILD.encode(), "triangle": damaged(chance, TRIANGLE, TRIANGLE) if chance.randrange(2)
                      else TRIANGLE, "report": damaged(chance, REPORT, REPORT)})
        (child / "child.sh").chmod(0o700)
        environment["NACRE_VTK_IMPORT"] = environment["NACRE_DICOM_IMPORT"] = str(child / "child.sh")
    else:
        name = chance.choice([name for name, content in files.items() if content])
        other = chance.choice(list(chance.choice(every)[1].values()))
        files = dict(files, **{name: damaged(chance, files[name], other)})
    write(work / "input", files)
    try:
        done = subprocess.run([program, "info", str(work / "input" / opened)], env=environment, timeout=200,
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)
    except subprocess.TimeoutExpired:
        return "not done in 200 s", ""
    errors = done.stderr.decode(errors="replace")
    return why_bad(done.returncode, errors, list((work / "temporary").iterdir())), errors


def main():
    program, runs, found = os.path.abspath(sys.argv[1]), int(sys.argv[2]), pathlib.Path(sys.argv[3])
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        def judge(number):
            work = pathlib.Path(scratch) / str(number)
            bad, errors = run(program, number, work)
            if bad:
                print(f"run {number}: {bad}: {errors[-300:]}")
                shutil.copytree(work, found / f"import-{number}", dirs_exist_ok=True)
            shutil.rmtree(work)
            return ("bad" if bad else "a child crashed" if re.search("crashed on it|Sanitizer", errors) else
                    "a child took too long" if "did not finish" in errors else
                    "refused" if errors.startswith("nacre:") else "read")

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            counts.update(pool.map(judge, range(runs)))
    print(f"imports: {runs} runs: " + ", ".join(f"{n} {what}" for what, n in sorted(counts.items())))
    return 1 if counts["bad"] else 0


if __name__ == "__main__":
    sys.exit(main())
