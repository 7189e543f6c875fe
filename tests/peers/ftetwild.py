#!/usr/bin/env python3
"""Nacre: fTetWild fills a surface mesh, such as one of ours, for run.sh.

ftetwild.py SURFACE.off [THREADS=2]

It aims at edges as long as the surface's are in the mean. Its cells need not keep the surface's triangles: they stay within
an envelope of a thousandth of the bounding box's diagonal, as by default. Results are lines of words; reading is not in the
seconds.
"""
import importlib.metadata
import os
import sys
import tempfile
import time

import numpy
import pytetwild


def read_off(path):
    """Points and triangles."""
    words = " ".join(line.partition("#")[0] for line in open(path)).split()
    if words[0] != "OFF":
        sys.exit(f"ftetwild.py: {path} is no OFF file")
    points, triangles = int(words[1]), int(words[2])
    end = 4 + 3 * points
    return (numpy.array(words[4:end], float).reshape(-1, 3),
            numpy.array(words[end:end + 4 * triangles], numpy.int64).reshape(-1, 4)[:, 1:].astype(numpy.int32))


def dihedral_degrees(points, cells):
    """Six angles between the faces of each cell."""
    corner = points[cells]
    normal = []  # of the face opposite each corner, outwards or all inwards
    for k in range(4):
        a, b, c = (corner[:, j] for j in range(4) if j != k)
        n = numpy.cross(b - a, c - a)
        n *= numpy.sign(numpy.einsum("ij,ij->i", n, a - corner[:, k]))[:, None]
        normal.append(n / numpy.maximum(numpy.linalg.norm(n, axis=1), 1e-300)[:, None])
    cosines = [-numpy.einsum("ij,ij->i", normal[j], normal[k]) for j in range(4) for k in range(j)]
    return numpy.degrees(numpy.arccos(numpy.clip(cosines, -1, 1)))


def main(path, threads="2"):
    points, triangles = read_off(path)
    mean = numpy.linalg.norm(points[triangles] - points[numpy.roll(triangles, 1, axis=1)], axis=2).mean()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # it leaves its surface where it runs
        started = time.perf_counter()
        vertices, cells = pytetwild.tetrahedralize(points, triangles, edge_length_abs=mean, num_threads=int(threads))
        seconds = time.perf_counter() - started
        os.chdir("/")
    angles = dihedral_degrees(vertices, cells)
    good = ((angles.min(axis=0) >= 10) & (angles.max(axis=0) <= 160)).mean()
    print(f"version fTetWild (pytetwild {importlib.metadata.version('pytetwild')})")
    for name, value in (("seconds", seconds), ("cells", len(cells)), ("cell_vertices", len(vertices)),
                        ("dihedral_min", angles.min()), ("dihedral_max", angles.max()), ("share_within_10_160", good)):
        print(name, f"{value:.10g}")


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
