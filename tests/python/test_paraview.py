# Nacre: the filters for ParaView, in pipelines of VTK alone.
import importlib.util

import numpy as np
import pytest
from conftest import bean, torus

import nacre

pyvista = pytest.importorskip("pyvista")
algorithm = pytest.importorskip("vtkmodules.util.vtkAlgorithm")
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkPolyData  # noqa: E402
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline  # noqa: E402


@pytest.fixture(scope="module")
def filters(folder):
    spec = importlib.util.spec_from_file_location("nacre_filters", folder / "python/paraview/nacre_filters.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def image():
    volume = pyvista.ImageData(dimensions=bean().T.shape, spacing=(0.7, 0.8, 1.25), origin=(1, 2, 3))
    volume.point_data["labels"] = bean().ravel()
    return volume


def test_mesh(filters):
    expected = nacre.mesh(image(), max_size=1.5)
    mesh = filters.NacreMesh()
    mesh.SetInputDataObject(image())
    mesh.SetMaxSize(1.5)
    mesh.Update()
    surface = pyvista.wrap(mesh.GetOutputDataObject(0))
    assert np.array_equal(surface.points, expected.points)
    assert np.array_equal(surface.regular_faces, expected.triangles)
    assert np.array_equal(surface.cell_data["material_1"], expected.materials[:, 1])
    mesh.SetTetrahedra(1)
    mesh.Update()
    grid = pyvista.wrap(mesh.GetOutputDataObject(0))
    cells = expected.tetrahedra()
    assert grid.n_cells == len(cells.cells) and np.array_equal(grid.cell_data["material"], cells.labels)
    mesh.SetMaterials("3")
    mesh.Update()
    assert set(pyvista.wrap(mesh.GetOutputDataObject(0)).cell_data["material"]) == {3}


def test_a_wrong_input_is_told(filters, capsys):
    mesh = filters.NacreMesh()
    mesh.SetInputDataObject(pyvista.ImageData(dimensions=(4, 4, 4)))
    mesh.Update()
    assert "no array with one number per voxel" in capsys.readouterr().out


class Source(algorithm.VTKPythonAlgorithmBase):
    """A torus whose velocity depends on time."""

    times = (0.0, 1.0, 2.0)

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self.asked = []
        points, triangles, self.velocity = torus(24, 12)
        self.surface = pyvista.PolyData.from_regular_faces(points, triangles)

    def RequestInformation(self, request, inputs, outputs):
        info = outputs.GetInformationObject(0)
        info.Set(Pipeline.TIME_STEPS(), self.times, len(self.times))
        info.Set(Pipeline.TIME_RANGE(), [self.times[0], self.times[-1]], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        time = outputs.GetInformationObject(0).Get(Pipeline.UPDATE_TIME_STEP())
        self.asked.append(time)
        output = vtkPolyData.GetData(outputs, 0)
        output.ShallowCopy(self.surface)
        array = numpy_to_vtk(self.velocity * (1 + time), deep=True)
        array.SetName("wind")
        output.GetPointData().AddArray(array)
        return 1


def texture(flow):
    surface = pyvista.wrap(flow.GetOutputDataObject(0))
    return surface, vtk_to_numpy(surface.GetPointData().GetArray("texture"))


def test_a_flow_in_time(filters):
    source, flow = Source(), filters.NacreSurfaceFlow()
    flow.SetInputConnection(source.GetOutputPort())
    flow.SetVectors("wind")
    flow.SetSteps(4)
    flow.SetResolution(96)
    flow.UpdateInformation()
    times = flow.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
    assert times == (0.5, 1.0, 1.5, 2.0)
    points, triangles, velocity = torus(24, 12)
    steps = np.stack([velocity * (1 + t) for t in Source.times])
    expected = nacre.flow(points, triangles, steps, times=Source.times, steps=4, resolution=96)
    for time in times:
        flow.UpdateTimeStep(time)
        surface, shown = texture(flow)
        frame = next(expected)
        assert np.allclose(shown, frame.sample(np.asarray(surface.points, float)))
        assert shown.std() > 0.05
    assert flow.runs == 1, "a step in time must not begin a new run"
    assert source.asked[:3] == list(Source.times) and len(source.asked) <= 4, "vectors are asked for once"
    assert surface.n_points > 5 * len(points)
    flow.UpdateTimeStep(0.5)
    assert flow.runs == 2
    first, _ = texture(flow)
    assert first.GetInformation().Get(first.DATA_TIME_STEP()) == 0.5


def test_a_steady_flow(filters):
    points, triangles, velocity = torus(24, 12)
    surface = pyvista.PolyData.from_regular_faces(points, triangles)
    surface.point_data["wind"] = velocity
    flow = filters.NacreSurfaceFlow()
    flow.SetInputDataObject(surface)
    flow.SetSteps(3)
    flow.SetResolution(96)
    flow.UpdateTimeStep(1.0)
    _, first = texture(flow)
    flow.UpdateTimeStep(3.0)
    _, last = texture(flow)
    assert flow.runs == 1 and first.shape == last.shape and not np.allclose(first, last)
