"""Nacre: ParaView's Surface LIC from a few cameras, for run.sh; run by pvpython.

surface_lic.py SURFACE.vtp CAMERAS.json FOLDER FRAMES

Writes FOLDER/theirs-K.png for every camera of CAMERAS.json (cameras as `nacre flow --camera` takes them, orthographic),
and FOLDER/theirs-K-plain.png without texture; then draws FRAMES pictures, the camera turned by half a degree between
them, and tells their median seconds. Settings of the representation are its own.
"""
import json
import math
import statistics
import sys
import time

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import read_vtp

SIZE = (1024, 768)


def aim(view, camera):
    view.CameraParallelProjection = 1
    view.CameraPosition = camera["eye"]
    view.CameraFocalPoint = camera["target"]
    view.CameraViewUp = camera["up"]
    view.CameraParallelScale = camera["height"] / 2


def turned(camera, degrees):
    """The camera led around its target about z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = (e - t for e, t in zip(camera["eye"], camera["target"]))
    t = camera["target"]
    return dict(camera, eye=[t[0] + c * x - s * y, t[1] + s * x + c * y, t[2] + z])


def source_of(path):
    """The surface as the output of a source in the pipeline."""
    places, triangles, vectors = read_vtp.read(path)
    points, cells, mesh = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(places, deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles).ravel(), deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    velocity = numpy_to_vtk(vectors, deep=True)
    velocity.SetName("velocity")
    mesh.GetPointData().AddArray(velocity)
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(mesh)
    source.UpdatePipeline()
    return source


def main(surface, cameras, folder, frames):
    simple._DisableFirstRenderCameraReset()
    view = simple.CreateView("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    shown = simple.Show(source_of(surface), view)
    shown.ColorArrayName = ["POINTS", ""]
    shown.DiffuseColor = shown.AmbientColor = [1, 1, 1]
    cameras = json.load(open(cameras))
    for kind, end in (("Surface", "-plain"), ("Surface LIC", "")):
        shown.SetRepresentationType(kind)
        if kind == "Surface LIC":
            shown.SelectInputVectors = ["POINTS", "velocity"]
        for k, camera in enumerate(cameras):
            aim(view, camera)
            simple.SaveScreenshot(f"{folder}/theirs-{k}{end}.png", view, ImageResolution=SIZE)
    seconds = []
    for k in range(int(frames) + 1):
        aim(view, turned(cameras[0], 0.5 * k))
        started = time.perf_counter()
        simple.Render(view)
        seconds.append(time.perf_counter() - started)
    version = simple.GetParaViewVersion()
    print(f"version ParaView {version.major}.{version.minor}")
    print("seconds", statistics.median(seconds[1:]))


if len(sys.argv) != 5:
    sys.exit(__doc__)
main(*sys.argv[1:])
