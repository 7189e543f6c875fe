#!/usr/bin/env python3
"""Nacre: the files that the fuzz targets begin with. Usage: seeds.py CORPUS: one folder for each target in CORPUS."""
import gzip
import os
import struct
import sys

CORPUS = sys.argv[1]


def give(target, *contents):
    folder = os.path.join(CORPUS, target)
    os.makedirs(folder, exist_ok=True)
    for number, content in enumerate(contents):
        if isinstance(content, str):
            content = content.encode()
        with open(os.path.join(folder, f"seed-{number}"), "wb") as file:
            file.write(content)


def array(name, kind, numbers, components=1):
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{numbers}'
            "</DataArray>")


def vtk(kind, grid, piece, content):
    return (f'<VTKFile type="{kind}" byte_order="LittleEndian" header_type="UInt64"><{kind} {grid}><Piece {piece}>'
            f"{content}</Piece></{kind}></VTKFile>")


def gifti(intent, kind, rows, numbers):
    return (f'<DataArray Intent="NIFTI_INTENT_{intent}" DataType="NIFTI_TYPE_{kind}" Encoding="ASCII" '
            f'Dimensionality="2" Dim0="{rows}" Dim1="3" ArrayIndexingOrder="RowMajorOrder" Endian="LittleEndian">'
            f"<Data>{numbers}</Data></DataArray>")


def surfaces():
    square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    give("obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1/1 2//2 -1/2/3\n")
    give("off", "OFF\n4 2 0\n" + square + "3 0 1 2\n3 0 2 3\n")
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    give("stl", "solid a\n" + facet + "endsolid a\n",
         b"binary".ljust(80, b"\0") + struct.pack("<I", 1) + struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0))
    head = ("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n")
    give("ply", "ply\nformat ascii 1.0\n" + head + "0 0 0 1\n1 0 0 2\n1 1 0 3\n3 0 1 2\n",
         ("ply\nformat binary_little_endian 1.0\n" + head).encode() +
         struct.pack("<12fB3i", 0, 0, 0, 1, 1, 0, 0, 2, 1, 1, 0, 3, 3, 0, 1, 2))
    give("gii", '<?xml version="1.0"?><GIFTI Version="1.0">' + gifti("POINTSET", "FLOAT32", 3, "0 0 0 1 0 0 1 1 0") +
         gifti("TRIANGLE", "INT32", 1, "0 1 2") + gifti("SHAPE", "FLOAT32", 3, "1 2 3 4 5 6 7 8 9") + "</GIFTI>")
    points = "<Points>" + array("Points", "Float32", "0 0 0 1 0 0 0 1 0 0 0 1", 3) + "</Points>"
    data = "<PointData>" + array("v", "Float32", "1 2 3 4 5 6 7 8 9 10 11 12", 3) + "</PointData>"
    give("vtp", vtk("PolyData", "", 'NumberOfPoints="4" NumberOfPolys="1"', data + points + "<Polys>" +
                    array("connectivity", "Int32", "0 1 2") + array("offsets", "Int32", "3") + "</Polys>"))
    give("vtu", vtk("UnstructuredGrid", "", 'NumberOfPoints="4" NumberOfCells="1"', data + points + "<Cells>" +
                    array("connectivity", "Int32", "0 1 2 3") + array("offsets", "Int32", "4") +
                    array("types", "UInt8", "10") + "</Cells>"))
    give("pvd", '<VTKFile type="Collection"><Collection><DataSet timestep="0" part="0" file="input.pvd"/></Collection>'
         "</VTKFile>")
    give("series", '{"file-series-version": "1.0", "files": [{"name": "b.vtp", "time": 0.5}]}')


def volumes():
    eight = bytes(range(8))
    give("vti", vtk("ImageData", 'WholeExtent="0 1 0 1 0 1" Origin="0 0 0" Spacing="1 1 1"', 'Extent="0 1 0 1 0 1"',
                    "<PointData>" + array("a", "Int16", "1 2 3 4 5 6 7 8") + "</PointData>"))
    head = "NRRD0004\ntype: uint8\n"
    segments = "".join(f"Segment{i}_Name:=s{i}\nSegment{i}_LabelValue:=1\nSegment{i}_Layer:={i}\n" for i in range(2))
    give("nrrd", head + "dimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\nencoding: ascii\n\n1 2 3 4 5 6 7 8",
         (head + "dimension: 3\nsizes: 2 2 2\nencoding: gzip\n\n").encode() + gzip.compress(eight),
         head + "dimension: 4\nspace: left-posterior-superior\nsizes: 2 2 2 2\nspace directions: none (1,0,0) (0,1,0) "
         "(0,0,1)\nkinds: list domain domain domain\nencoding: ascii\nspace origin: (0,0,0)\n" + segments +
         "\n1 0 1 1 0 0 0 1 1 0 1 1 0 0 0 1")
    give("mha", "NDims = 3\nDimSize = 2 2 2\nElementSpacing = 1 1 1\nBinaryData = False\nElementType = MET_UCHAR\n"
         "ElementDataFile = LOCAL\n1 2 3 4 5 6 7 8")
    nifti = bytearray(352)
    for kind, at, numbers in [("i", 0, [348]), ("8h", 40, [3, 2, 2, 2, 1, 1, 1, 1]), ("2h", 70, [2, 8]),
                              ("4f", 76, [1, 1, 1, 1]), ("3f", 108, [352, 2, 1]), ("2h", 252, [1, 1]),
                              ("12f", 280, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0])]:
        struct.pack_into("<" + kind, nifti, at, *numbers)
    nifti[344:348] = b"n+1\0"
    give("nii", bytes(nifti) + eight)
    mgh = bytearray(284)
    struct.pack_into(">7i", mgh, 0, 1, 2, 2, 2, 1, 0, 0)
    give("mgz", bytes(mgh) + eight, gzip.compress(bytes(mgh) + eight))
    inr = (b"#INRIMAGE-4#{\nXDIM=2\nYDIM=2\nZDIM=2\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nSCALE=2**0\nCPU=pc\n"
           b"VX=1\nVY=1\nVZ=1\n")
    give("inr", inr.ljust(252, b"\n") + b"##}\n" + eight)


def options():
    give("labels", '# labels\n1 255 0 0 1 1 1 "left lung"\n2 liver\n17 Left-Hippocampus 220 216 20 0\n')
    camera = '{"eye": [1, 2, 3], "target": [0, 0, 0], "up": [0, 0, 1], "height": 2, "orthographic": false}'
    give("camera", camera)
    give("session", '{"nacre": "session 1", "sample": "torus", "detail": 24, "knobs": {"steps": 5, "ttl": 3}, "camera": '
         + camera + ', "events": [{"time": 0.4, "knobs": {"ttl": 3}, "camera": ' + camera + ', "over": 1}, {"time": 2, '
         '"screenshot": {"file": "a.png", "scale": 2}}], "duration": 5}')
    give("knobs", "step_cells=3.5", "camera=+x", "color_range=0:1", "isovalue=1,2", "materials=1,2", "merge=1:2",
         "seed=7", "method=octree", "no-such-knob=1", "legend=false", "background=#102030")
    give("expressions", "0640x480", "110:1.5", "20:1", "225%:95%", "330.5,1e3", "441,2,-3", "551:2,3:2", "6v_0.50s")


surfaces()
volumes()
options()
