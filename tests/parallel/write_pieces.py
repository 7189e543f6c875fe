#!/usr/bin/env python3
"""Writes a series of surfaces in pieces: NAME.pvd, its steps as .pvtp, and the pieces of those.

A sphere of small triangles stands beside a box whose sides are two triangles each, and a sheet. Pieces have points of
their own, and triangles of neighbouring pieces meet at them. Some triangles are wound the wrong way, a part is inside
out, one piece is empty, and another has all of the box. Usage: write_pieces.py NAME [PIECES [STEPS [ROWS]]]
"""
import math
import sys
from pathlib import Path


def sphere(rows):
    points, triangles = [], []
    for i in range(rows + 1):
        for j in range(2 * rows):
            u, v = math.pi * i / rows, math.pi * j / rows
            points.append((math.sin(u) * math.cos(v), math.sin(u) * math.sin(v), math.cos(u)))
    for i in range(rows):
        for j in range(2 * rows):
            a, b = 2 * rows * i + j, 2 * rows * i + (j + 1) % (2 * rows)
            c, d = a + 2 * rows, b + 2 * rows
            if i > 0:
                triangles.append((a, c, b))
            if i < rows - 1:
                triangles.append((b, c, d))
    return points, triangles


def box(x):
    points = [(x + (i & 1) * 1.5, (i >> 1 & 1) * 1.5 - 0.7, (i >> 2) * 1.5 - 0.8) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for q in quads for t in ((q[0], q[2], q[1]), (q[0], q[3], q[2]))]  # inside out


def sheet(x):
    points = [(x + 0.1 * i, 0.2 * j - 1, 0.3 * math.sin(0.7 * i + j)) for i in range(11) for j in range(11)]
    corners = [(11 * i + j, 11 * i + j + 1, 11 * i + j + 11, 11 * i + j + 12) for i in range(10) for j in range(10)]
    return points, [t for a, b, c, d in corners for t in ((a, b, c), (b, d, c))]


def array(name, numbers, kind, components=1):
    text = " ".join(str(n) for n in numbers)
    head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
    return f"{head}{text}</DataArray>\n"


def write_piece(path, points, triangles, time):
    velocity, pressure = [], []
    for x, y, z in points:
        velocity += [f"{-y + 0.3 * math.sin(3 * z + time):.6f}", f"{x - 0.2 * time * z:.6f}",
                     f"{0.4 * math.cos(x + time):.6f}"]
        pressure.append(f"{x * y - z + 0.1 * time:.6f}")
    corners = [c for t in triangles for c in t]
    ends = [3 * (k + 1) for k in range(len(triangles))]
    density = [f"{sum(points[c][0] for c in t):.6f}" for t in triangles]
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(triangles)}">\n<Points>\n'
        + array("Points", [repr(c) for p in points for c in p], "Float64", 3)
        + "</Points>\n<Polys>\n" + array("connectivity", corners, "Int64") + array("offsets", ends, "Int64")
        + "</Polys>\n<PointData>\n" + array("velocity", velocity, "Float32", 3) + array("pressure", pressure, "Float32")
        + "</PointData>\n<CellData>\n" + array("density", density, "Float32")
        + "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n")


def main():
    name = Path(sys.argv[1])
    pieces, steps, rows = (int(a) for a in (sys.argv[2:5] + ["5", "3", "24"][len(sys.argv) - 2:]))
    points, triangles, parts = [], [], []
    for part in (sphere(rows), sheet(-3.2), box(1.6)):
        first = len(points)
        points += part[0]
        parts.append([tuple(first + c for c in t) for t in part[1]])
    small = [t if k % 7 else (t[0], t[2], t[1]) for k, t in enumerate(parts[0] + parts[1])]
    n = max(1, pieces - 2)
    lists = [small[len(small) * k // n:len(small) * (k + 1) // n] for k in range(n)]
    if pieces > 2:
        lists.insert(1, [])
    if pieces > 1:
        lists.insert(2, parts[2])
    else:
        lists[0] += parts[2]
    entries = ""
    for step in range(steps):
        sources = ""
        for k, own in enumerate(lists):
            used = sorted({c for t in own for c in t})
            number = {p: i for i, p in enumerate(used)}
            file = name.with_name(f"{name.name}_{step}_{k}.vtp")
            write_piece(file, [points[p] for p in used], [tuple(number[c] for c in t) for t in own], 0.5 * step)
            sources += f'<Piece Source="{file.name}"/>\n'
        file = name.with_name(f"{name.name}_{step}.pvtp")
        file.write_text('<?xml version="1.0"?>\n<VTKFile type="PPolyData" version="1.0" byte_order="LittleEndian">\n'
                        f'<PPolyData GhostLevel="0">\n{sources}</PPolyData>\n</VTKFile>\n')
        entries += f'<DataSet timestep="{0.5 * step}" file="{file.name}"/>\n'
    name.with_suffix(".pvd").write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n'
                                        f"<Collection>\n{entries}</Collection>\n</VTKFile>\n")


main()
