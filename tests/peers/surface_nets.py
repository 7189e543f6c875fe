#!/usr/bin/env python3
"""Nacre: VTK's surface nets on a label image, with their own smoothing, for run.sh.

surface_nets.py LABELS.nrrd OUT.off [THREADS]

LABELS.nrrd as `nacre sample` writes it: three dimensions, bytes, raw or gzip, axes along the world's. Results are lines
of words; vertices cannot be chosen, there is one per voxel corner that the surface passes.
"""
import ast
import sys
import time
import zlib

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def read_labels(path):
    """Array of labels indexed z, y, x; spacing; origin."""
    data = open(path, "rb").read()
    head, body = data.split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines()[1:] if ": " in line)
    if fields["type"] not in ("uint8", "unsigned char", "uchar"):
        sys.exit(f"surface_nets.py: {path} holds {fields['type']}, not bytes")
    if fields["encoding"] in ("gzip", "gz"):
        body = zlib.decompress(body, 47)
    sizes = [int(n) for n in fields["sizes"].split()]
    directions = [ast.literal_eval(v) for v in fields["space directions"].split()]
    origin = ast.literal_eval(fields["space origin"])
    labels = numpy.frombuffer(body, numpy.uint8).reshape(sizes[::-1])
    return labels, [directions[k][k] for k in range(3)], origin


def make_image(labels, spacing, origin):
    """The labels as VTK's image, with a voxel of outside around them: its sides are surfaces like any other."""
    labels = numpy.pad(labels, 1)
    image = vtk.vtkImageData()
    image.SetDimensions(labels.shape[::-1])
    image.SetSpacing(spacing)
    image.SetOrigin([o - s for o, s in zip(origin, spacing)])
    scalars = numpy_to_vtk(labels.ravel(), deep=True)
    scalars.SetName("label")
    image.GetPointData().SetScalars(scalars)
    return image


def main(path, out, threads="2"):
    if vtk.vtkSMPTools.GetBackend() == "Sequential":
        vtk.vtkSMPTools.SetBackend("STDThread")
    vtk.vtkSMPTools.Initialize(int(threads))
    labels, spacing, origin = read_labels(path)
    nets = vtk.vtkSurfaceNets3D()
    nets.SetInputData(make_image(labels, spacing, origin))
    for number, label in enumerate(sorted(set(labels.ravel()) - {0})):
        nets.SetLabel(number, int(label))
    nets.SetOutputMeshTypeToTriangles()
    started = time.perf_counter()
    nets.Update()
    seconds = time.perf_counter() - started
    mesh = nets.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    print("version VTK", vtk.vtkVersion().GetVTKVersion())
    print("threads", vtk.vtkSMPTools.GetEstimatedNumberOfThreads())
    print("seconds", seconds)
    with open(out, "w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        numpy.savetxt(file, points, "%.9g")
        numpy.savetxt(file, numpy.insert(triangles, 0, 3, axis=1), "%d")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
