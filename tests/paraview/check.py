# Nacre: the plugin in ParaView: both filters through the server manager, as its menus make them, and their pictures.
# Usage: pvpython check.py PLUGIN FOLDER
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataWriter

import nacre

plugin, folder = sys.argv[1:]
print("ParaView", simple.GetParaViewVersion(), "with Python", sys.version.split()[0], "and Nacre", nacre.__version__)


def write(writer, data, name):
    writer.SetFileName(f"{folder}/{name}")
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    assert writer.Write()
    return f"{folder}/{name}"


def labels():
    z, y, x = np.mgrid[:28, :28, :28] - 13.5
    values = np.zeros(x.shape, np.uint8)
    values[x * x + y * y + 1.5 * z * z < 140] = 1
    values[(x - 4) ** 2 + y * y + z * z < 40] = 2
    image = vtkImageData()
    image.SetDimensions(28, 28, 28)
    image.SetSpacing(0.5, 0.5, 0.5)
    array = numpy_to_vtk(values.ravel(), deep=True)
    array.SetName("labels")
    image.GetPointData().SetScalars(array)
    return values, write(vtkXMLImageDataWriter(), image, "labels.vti")


def torus_in_time(times, n=64, m=32):
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    r = 2 + 0.8 * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), 0.8 * np.sin(v)], -1).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    right, up = (i + 1) % n, (j + 1) % m
    quads = np.stack([i * m + j, right * m + j, right * m + up, i * m + up], -1)
    around = np.stack([-points[:, 1], points[:, 0], np.zeros(len(points))], -1)
    files = []
    for k, time in enumerate(times):
        surface = vtkPolyData()
        position = vtkPoints()
        position.SetData(numpy_to_vtk(points, deep=True))
        surface.SetPoints(position)
        cells = vtkCellArray()
        for quad in quads:
            for corners in (quad[[0, 1, 2]], quad[[0, 2, 3]]):
                cells.InsertNextCell(3, [int(c) for c in corners])
        surface.SetPolys(cells)
        array = numpy_to_vtk(around + [0, 0, 2 * np.cos(np.pi * time)], deep=True)
        array.SetName("wind")
        surface.GetPointData().AddArray(array)
        write(vtkXMLPolyDataWriter(), surface, f"torus_{k}.vtp")
        files.append(f'<DataSet timestep="{time}" file="torus_{k}.vtp"/>')
    name = f"{folder}/torus.pvd"
    with open(name, "w", encoding="ascii") as out:
        out.write(f'<VTKFile type="Collection" version="0.1"><Collection>{"".join(files)}</Collection></VTKFile>')
    return name


def picture(view, name):
    simple.Render(view)
    simple.SaveScreenshot(f"{folder}/{name}", view, ImageResolution=[640, 480])
    reader = vtkPNGReader()
    reader.SetFileName(f"{folder}/{name}")
    reader.Update()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(480, 640, -1)[..., :3].astype(float)
    assert values.std() > 15, f"{name} is blank: {values.std()}"
    return values


def data_of(proxy):
    return servermanager.Fetch(proxy)


simple.LoadPlugin(plugin, remote=False, ns=globals())
values, file = labels()
image = simple.XMLImageDataReader(FileName=[file])
mesh = NacreMesh(Input=image, MaxSize=1.5)  # noqa: F821, a name that LoadPlugin makes
mesh.UpdatePipeline()
surface = data_of(mesh)
expected = nacre.mesh(values, spacing=(0.5, 0.5, 0.5), max_size=1.5)
points = vtk_to_numpy(surface.GetPoints().GetData())
assert np.array_equal(points, expected.points), "other points than nacre.mesh gives"
sides = vtk_to_numpy(surface.GetCellData().GetArray("material_1"))
assert np.array_equal(sides, expected.materials[:, 1])
expected.save(f"{folder}/mesh.vtp")
expected.save(f"{folder}/mesh.vtu")
for kind, name, count in ((simple.XMLPolyDataReader, "mesh.vtp", len(expected.triangles)),
                          (simple.XMLUnstructuredGridReader, "mesh.vtu", len(expected.tetrahedra().cells))):
    read = data_of(kind(FileName=[f"{folder}/{name}"]))
    assert read.GetNumberOfCells() == count, f"{name}: {read.GetNumberOfCells()} cells, not {count}"
print("mesh.vtp and mesh.vtu, as Nacre writes them, are read")
mesh.Tetrahedra = 1
mesh.UpdatePipeline()
grid = data_of(mesh)
kinds = vtk_to_numpy(grid.GetCellData().GetArray("material"))
assert grid.GetClassName() == "vtkUnstructuredGrid" and set(kinds) == {1, 2}
view = simple.CreateView("RenderView")
view.ViewSize = [640, 480]
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
cut = simple.Clip(Input=mesh, Crinkleclip=1)
cut.Invert = 0
cut.ClipType.Normal = [0, 1, 0]
cut.ClipType.Origin = [6.75, 6.75, 6.75]
shown = simple.Show(cut, view)
shown.Representation = "Surface With Edges"
simple.ColorBy(shown, ("CELLS", "material"))
view.ResetCamera(False)
camera = simple.GetActiveCamera()
camera.SetPosition(6.75, -25, 14)
camera.SetFocalPoint(6.75, 6.75, 6.75)
camera.SetViewUp(0, 0, 1)
picture(view, "paraview_mesh.png")
print(f"Nacre Mesh: {surface.GetNumberOfPolys()} triangles, {grid.GetNumberOfCells()} tetrahedra, as nacre.mesh gives them")

flow_view = simple.CreateView("RenderView")
flow_view.ViewSize = [640, 480]
flow_view.UseColorPaletteForBackground = 0
flow_view.Background = [1, 1, 1]
reader = simple.PVDReader(FileName=torus_in_time([0.0, 0.5, 1.0]))
flow = NacreSurfaceFlow(Input=reader, Vectors="wind", Steps=6, Resolution=160)  # noqa: F821
flow.UpdatePipelineInformation()
times = list(flow.TimestepValues)
assert len(times) == 6 and times[-1] == 1.0, times
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
shown = simple.Show(flow, flow_view)
simple.ColorBy(shown, ("POINTS", "texture_colors"))
shown.MapScalars = 0  # the bytes are the colours
simple.SetActiveView(flow_view)
flow_view.ResetCamera(False)
pictures, textures = [], []
for k, time in enumerate(times[:3]):
    flow_view.ViewTime = time
    pictures.append(picture(flow_view, f"paraview_flow_{k}.png"))
    textures.append(vtk_to_numpy(data_of(flow).GetPointData().GetArray("texture")).copy())
assert textures[0].shape == textures[2].shape and textures[0].std() > 0.05
moved = [float(np.abs(a - b).mean()) for a, b in zip(textures, textures[1:])]
assert all(m > 0.005 for m in moved), f"the texture does not move: {moved}"
assert np.abs(pictures[0] - pictures[2]).mean() > 0.5, "the pictures are the same"
print(f"Nacre Surface Flow: {data_of(flow).GetNumberOfPoints()} points carry the texture; it moves by {moved} a step")
