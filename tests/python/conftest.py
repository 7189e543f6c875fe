# Nacre: what the tests of the Python module share.
import os
import pathlib
import re
import subprocess

import numpy as np
import pytest

import nacre


def result_bytes(path):
    """A result without the line that says how it was made: the program names files there, the module arrays."""
    content = path.read_bytes()
    origin = rb'\{"Nacre origin":[^\n]*'
    for line in (rb"<!-- " + origin + rb" -->\n", rb"(?:comment|#) " + origin + rb"\n",
                 rb"\$Comments\n" + origin + rb"\n\$EndComments\n"):
        content = re.sub(line, b"", content, count=1)
    chunk = content.find(b"tEXtSource\0")
    if chunk >= 0:
        length = int.from_bytes(content[chunk - 4:chunk], "big")
        content = content[:chunk - 4] + content[chunk + 8 + length:]
    return content


def assert_equal(ours, theirs, where):
    """Parts of two reports. Means may differ in their last digits: program and module are compiled one by one, and what
    the compiler fuses may differ. What is written to files is compared to the byte elsewhere."""
    assert type(ours) is type(theirs), where
    if isinstance(ours, dict):
        assert list(ours) == list(theirs), where
        for key in ours:
            assert_equal(ours[key], theirs[key], f"{where}.{key}")
    elif isinstance(ours, list):
        assert len(ours) == len(theirs), where
        for i, (a, b) in enumerate(zip(ours, theirs)):
            assert_equal(a, b, f"{where}[{i}]")
    elif isinstance(ours, float):
        assert ours == pytest.approx(theirs, rel=1e-8, abs=1e-12), where
    else:
        assert ours == theirs, where


@pytest.fixture(scope="session")
def program():
    """The program, to compare with."""
    path = os.environ.get("NACRE_PROGRAM", "")
    if not path:
        pytest.skip("NACRE_PROGRAM is not set: there is no program to compare with")

    def run(*arguments):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done

    return run


@pytest.fixture(scope="session")
def folder():
    """Nacre's sources."""
    return pathlib.Path(os.environ.get("NACRE_FOLDER", pathlib.Path(__file__).parents[2]))


def two_balls(size=24, dtype=np.uint8):
    """A ball of label 5 in one of label 2, z y x."""
    z, y, x = np.mgrid[:size, :size, :size] - (size - 1) / 2
    r = np.sqrt(x * x + y * y + z * z)
    labels = np.zeros(r.shape, dtype)
    labels[r < 0.4 * size] = 2
    labels[r < 0.2 * size] = 5
    return labels


def bean():
    """Three labels, no symmetry, as many voxels along no two axes."""
    z, y, x = np.mgrid[:18, :22, :26]
    labels = np.zeros(x.shape, np.int16)
    labels[(x - 12) ** 2 + 1.4 * (y - 11) ** 2 + 2 * (z - 9) ** 2 < 80] = 3
    labels[(x - 16) ** 2 + (y - 10) ** 2 + (z - 8) ** 2 < 20] = 9
    labels[(x - 8) ** 2 + (y - 12) ** 2 + (z - 10) ** 2 < 14] = -4
    return labels


def torus(n=40, m=20):
    """Points, triangles and a velocity around the axis."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    r = 2 + 0.7 * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), 0.7 * np.sin(v)], -1).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    right, up = (i + 1) % n, (j + 1) % m
    quads = np.stack([i * m + j, right * m + j, right * m + up, i * m + up], -1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    velocity = np.stack([-points[:, 1], points[:, 0], np.full(len(points), 0.3)], -1)
    return points, triangles, velocity


def write_nrrd(file, labels, spacing=(1, 1, 1), origin=(0, 0, 0)):
    """A NRRD file with x fastest, as numpy stores z y x."""
    types = {"uint8": "uint8", "int16": "int16", "float32": "float"}
    z, y, x = labels.shape
    steps = " ".join("(" + ",".join(repr(float(s if a == b else 0)) for b in range(3)) + ")" for a, s in enumerate(spacing))
    header = (
        f"NRRD0004\ntype: {types[labels.dtype.name]}\ndimension: 3\nspace: right-anterior-superior\nsizes: {x} {y} {z}\n"
        f"space directions: {steps}\nspace origin: ({','.join(repr(float(o)) for o in origin)})\n"
        "kinds: domain domain domain\nendian: little\nencoding: raw\n\n"
    )
    file.write_bytes(header.encode() + np.ascontiguousarray(labels).tobytes())


def write_vtp(file, points, triangles, velocity):
    def numbers(array):
        return " ".join(repr(float(v)) for v in np.ravel(array))

    file.write_text(
        '<?xml version="1.0"?><VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(triangles)}"><PointData>'
        '<DataArray type="Float32" Name="velocity" NumberOfComponents="3" format="ascii">'
        f'{numbers(velocity)}</DataArray></PointData><Points><DataArray type="Float64" NumberOfComponents="3" '
        f'format="ascii">{numbers(points)}</DataArray></Points><Polys>'
        f'<DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(map(str, np.ravel(triangles)))}</DataArray>'
        f'<DataArray type="Int64" Name="offsets" format="ascii">'
        f'{" ".join(str(3 * k + 3) for k in range(len(triangles)))}</DataArray></Polys></Piece></PolyData></VTKFile>'
    )


@pytest.fixture(scope="session")
def ball_mesh():
    return nacre.mesh(two_balls(), spacing=(0.5, 0.5, 0.5), names={2: "shell", 5: "core"})
