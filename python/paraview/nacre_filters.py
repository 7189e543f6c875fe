# Nacre: two filters for ParaView, and for pipelines of VTK.
"""Nacre Mesh and Nacre Surface Flow as filters.

ParaView: Tools > Manage Plugins > Load New, choose this file. The `nacre` module must be on the path of ParaView's
Python. Without ParaView the same classes are filters of VTK:

    mesh = NacreMesh()
    mesh.SetInputDataObject(image)
    mesh.Update()
    grid = mesh.GetOutputDataObject(0)
"""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_TETRA,
    vtkCellArray,
    vtkImageData,
    vtkPolyData,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersModeling import vtkAdaptiveSubdivisionFilter

import nacre

try:
    from paraview.util.vtkAlgorithm import smdomain, smproperty, smproxy
except ImportError:  # VTK without ParaView: the same classes, without their entries in menus

    class _Plain:
        def __getattr__(self, name):
            return lambda *args, **kwargs: lambda decorated: decorated

    smdomain = smproperty = smproxy = _Plain()


def _points(array):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(array), deep=True))
    return points


def _cells(corners):
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, corners.size + 1, corners.shape[1], dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(corners.ravel(), dtype=np.int64), deep=True),
    )
    return cells


def _add(data, name, values, vtk_type=None):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True, array_type=vtk_type)
    array.SetName(name)
    data.AddArray(array)


class _Filter(VTKPythonAlgorithmBase):
    """What both filters share: knobs by name, and errors in the log of the application."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self._knobs = {}

    def SetKnob(self, name, value):
        """Set any knob of nacre.mesh or nacre.flow by its name; None: its default."""
        if self._knobs.get(name) != value:
            self._knobs[name] = value
            self.Modified()

    def _tell(self, error):
        self._error = error
        self.GetInformation()  # keeps VTK from ending a pipeline of Python without a word
        print(f"Nacre: {error}")
        return 0


@smproxy.filter(label="Nacre Mesh")
@smproperty.input(name="Input")
@smdomain.datatype(dataTypes=["vtkImageData"], composite_data_supported=False)
class NacreMesh(_Filter):
    """A volume of labels (or of scalars, with iso-values) becomes a conformal mesh.

    The output is a vtkPolyData of triangles with the cell arrays material_0 and material_1, the labels on both sides;
    or, with Tetrahedra, a vtkUnstructuredGrid with the cell array material.
    """

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=1, outputType="vtkPointSet")
        self._tetrahedra = False

    @smproperty.intvector(name="Tetrahedra", default_values=0)
    @smdomain.xml('<BooleanDomain name="bool"/>')
    def SetTetrahedra(self, on):
        self._tetrahedra = bool(on)
        self.Modified()

    @smproperty.doublevector(name="MinSize", default_values=0.5)
    def SetMinSize(self, value):
        self.SetKnob("min_size", value)

    @smproperty.doublevector(name="MaxSize", default_values=1.0)
    def SetMaxSize(self, value):
        self.SetKnob("max_size", value)

    @smproperty.stringvector(name="Isovalues", default_values="")
    def SetIsovalues(self, text):
        self.SetKnob("isovalue", text or None)

    @smproperty.stringvector(name="Materials", default_values="")
    def SetMaterials(self, text):
        self.SetKnob("materials", text or None)

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkImageData")
        return 1

    def RequestDataObject(self, request, inputs, outputs):
        wanted = vtkUnstructuredGrid if self._tetrahedra else vtkPolyData
        present = wanted.GetData(outputs, 0)
        if present is None or type(present) is not wanted:
            outputs.GetInformationObject(0).Set(wanted.DATA_OBJECT(), wanted())
        return 1

    def RequestData(self, request, inputs, outputs):
        image = vtkImageData.GetData(inputs[0], 0)
        try:
            mesh = nacre.mesh(image, progress=self._progress, **self._knobs)
            cells = mesh.tetrahedra() if self._tetrahedra else None
        except nacre.Error as error:
            return self._tell(error)
        if cells is not None:
            output = vtkUnstructuredGrid.GetData(outputs, 0)
            output.SetPoints(_points(cells.points))
            output.SetCells(VTK_TETRA, _cells(cells.cells))
            _add(output.GetCellData(), "material", cells.labels)
            return 1
        output = vtkPolyData.GetData(outputs, 0)
        output.SetPoints(_points(mesh.points))
        output.SetPolys(_cells(mesh.triangles))
        _add(output.GetCellData(), "material_0", mesh.materials[:, 0])
        _add(output.GetCellData(), "material_1", mesh.materials[:, 1])
        return 1

    def _progress(self, stage, fraction, *_):
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()


@smproxy.filter(label="Nacre Surface Flow")
@smproperty.input(name="Input")
@smdomain.datatype(dataTypes=["vtkPolyData"], composite_data_supported=False)
class NacreSurfaceFlow(_Filter):
    """A surface with vectors at its points becomes one that carries the moving texture.

    The output is cut to triangles about as small as the cells of the texture, with the point arrays `texture` (0..1)
    and `texture_colors` (grey, for direct colouring), and has one time step per frame. Where the input has time steps,
    vectors are asked for at all of them, once, and frames are spread evenly over them; a steady input gets the times 1
    to `steps`. One run is kept: the next time step costs one step of the texture. A time before the present one begins
    again.
    """

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=1, outputType="vtkPolyData")
        self._vectors = ""
        self._steps = 20
        self._times = []  # of the input
        self._collected = []  # vectors at these
        self._reading = None  # which is read
        self._state = None  # of what the run was made
        self._flow = self._frame = self._surface = None
        self.runs = 0  # how many were begun

    @smproperty.stringvector(name="Vectors", default_values="")
    def SetVectors(self, name):
        self._vectors = name
        self.Modified()

    @smproperty.intvector(name="Steps", default_values=20)
    def SetSteps(self, steps):
        self._steps = max(1, int(steps))
        self.Modified()

    @smproperty.intvector(name="Resolution", default_values=512)
    def SetResolution(self, resolution):
        self.SetKnob("resolution", int(resolution))

    @smproperty.intvector(name="TimeToLive", default_values=4)
    def SetTimeToLive(self, steps):
        self.SetKnob("ttl", int(steps))

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData")
        return 1

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        return self._frame_times()

    def _frame_times(self):
        if len(self._times) > 1:
            first, last = self._times[0], self._times[-1]
            return [first + (last - first) * (k + 1) / self._steps for k in range(self._steps)]
        return [float(k + 1) for k in range(self._steps)]

    def RequestInformation(self, request, inputs, outputs):
        info = inputs[0].GetInformationObject(0)
        times = info.Get(Pipeline.TIME_STEPS()) if info.Has(Pipeline.TIME_STEPS()) else ()
        self._times = [float(t) for t in times]
        frames = self._frame_times()
        out = outputs.GetInformationObject(0)
        out.Set(Pipeline.TIME_STEPS(), frames, len(frames))
        out.Set(Pipeline.TIME_RANGE(), [frames[0], frames[-1]], 2)
        return 1

    def _present_state(self, surface):
        knobs = tuple(sorted((k, v) for k, v in self._knobs.items()))
        return (surface.GetPoints().GetMTime(), surface.GetNumberOfPoints(), self._vectors, self._steps, knobs,
                tuple(self._times), self.GetInputConnection(0, 0))

    def RequestUpdateExtent(self, request, inputs, outputs):
        if len(self._times) > 1:
            read = self._reading if self._reading is not None else -1 if self._collected else 0
            inputs[0].GetInformationObject(0).Set(Pipeline.UPDATE_TIME_STEP(), self._times[read])
        return 1

    def _array(self, surface):
        data = surface.GetPointData()
        array = data.GetArray(self._vectors) if self._vectors else data.GetVectors()
        if array is None and not self._vectors:
            arrays = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
            array = next((a for a in arrays if a is not None and a.GetNumberOfComponents() == 3), None)
        if array is None or array.GetNumberOfComponents() != 3:
            names = [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]
            raise nacre.Error(f"the surface has no point vectors {self._vectors!r}", f"its arrays are {names}")
        return np.array(vtk_to_numpy(array), dtype=np.float32)

    def _begin(self, surface):
        triangles = vtkTriangleFilter()
        triangles.SetInputData(surface)
        triangles.PassLinesOff()
        triangles.PassVertsOff()
        triangles.Update()
        plain = vtkPolyData()
        plain.SetPoints(triangles.GetOutput().GetPoints())
        plain.SetPolys(triangles.GetOutput().GetPolys())
        points = np.array(vtk_to_numpy(plain.GetPoints().GetData()), dtype=float)
        corners = vtk_to_numpy(plain.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        times = self._times if len(self._times) > 1 else None
        self._flow = nacre.flow(
            points, corners, np.stack(self._collected), times=times, steps=self._steps, **self._knobs
        )
        self.runs += 1
        self._frame = None
        cut = vtkAdaptiveSubdivisionFilter()
        cut.SetInputData(plain)
        cell = (points.max(0) - points.min(0)).max() / self._flow.resolution
        cut.SetMaximumEdgeLength(1.5 * cell)
        cut.SetMaximumTriangleArea(4 * cell * cell)
        cut.Update()
        self._surface = vtkPolyData()
        self._surface.ShallowCopy(cut.GetOutput())

    def RequestData(self, request, inputs, outputs):
        surface = vtkPolyData.GetData(inputs[0], 0)
        out = outputs.GetInformationObject(0)
        try:
            if self._read_more(request, surface):
                return 1
            wanted = out.Get(Pipeline.UPDATE_TIME_STEP()) if out.Has(Pipeline.UPDATE_TIME_STEP()) else None
            self._advance(surface, wanted)
            positions = np.array(vtk_to_numpy(self._surface.GetPoints().GetData()), dtype=float)
            texture = self._frame.sample(positions)
        except nacre.Error as error:
            self._reading = self._state = None
            request.Remove(Pipeline.CONTINUE_EXECUTING())
            return self._tell(error)
        output = vtkPolyData.GetData(outputs, 0)
        output.ShallowCopy(self._surface)
        _add(output.GetPointData(), "texture", texture)
        grey = np.repeat(np.clip(texture * 255, 0, 255).astype(np.uint8)[:, None], 3, axis=1)
        _add(output.GetPointData(), "texture_colors", grey, VTK_UNSIGNED_CHAR)
        output.GetPointData().SetActiveScalars("texture")
        output.GetInformation().Set(output.DATA_TIME_STEP(), self._frame_times()[self._frame.index])
        return 1

    def _read_more(self, request, surface):
        """Collects the vectors of all time steps, one a call; True where the input has to be run again."""
        state = self._present_state(surface)
        if self._reading is None:
            if self._state == state:
                return False
            self._state, self._collected, self._flow = state, [], None
        if len(self._times) <= 1:
            self._collected = [self._array(surface)]
            self._begin(surface)
            return False
        if self._reading is None:
            self._reading = 0
            request.Set(Pipeline.CONTINUE_EXECUTING(), 1)
            return True
        self._collected.append(self._array(surface))
        self._reading += 1
        if self._reading < len(self._times):
            request.Set(Pipeline.CONTINUE_EXECUTING(), 1)
            return True
        request.Remove(Pipeline.CONTINUE_EXECUTING())
        self._reading = None
        self._state = self._present_state(surface)
        self._begin(surface)
        return False

    def _advance(self, surface, wanted):
        frames = self._frame_times()
        index = 0 if wanted is None else int(np.argmin(np.abs(np.subtract(frames, wanted))))
        if self._frame is not None and self._frame.index > index:
            self._begin(surface)
        while self._frame is None or self._frame.index < index:
            self._frame = next(self._flow)
            self.UpdateProgress((self._frame.index + 1) / (index + 1))
