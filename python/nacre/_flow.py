# Nacre: flow on surfaces.
"""Unsteady flow on a surface as a moving texture."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import knob, knob_dict, real_array, rows, three
from ._errors import Error
from ._processes import Processes

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._knobs import FlowKnobs
    from ._mesh import Progress


@dataclass(frozen=True)
class FlowCells:
    """One row per cell that the surface crosses, in world coordinates."""

    centre: NDArray[np.float64]  #: (n, 3)
    closest_point: NDArray[np.float64]  #: (n, 3) on the surface
    value: NDArray[np.float32]  #: (n,) of the texture, 0..1
    velocity: NDArray[np.float32]  #: (n, 3) tangential vector at the time of the frame
    normal: NDArray[np.float32]  #: (n, 3) unit


def _camera(camera: Any) -> Any:
    """A name of a view, a mapping, or what PyVista calls a camera position: (eye, target, up)."""
    if camera is None or isinstance(camera, str):
        return camera
    if isinstance(camera, Mapping):
        unknown = set(camera) - {"eye", "target", "up", "height", "orthographic"}
        if unknown or "eye" not in camera or "target" not in camera or "height" not in camera:
            raise Error("this is not a camera", "", "give eye, target, height and perhaps up and orthographic")
        return {
            "eye": list(three(camera["eye"], "eye")),
            "target": list(three(camera["target"], "target")),
            "up": list(three(camera.get("up", (0, 0, 1)), "up")),
            "height": float(camera["height"]),
            "orthographic": bool(camera.get("orthographic", False)),
        }
    if hasattr(camera, "position") and hasattr(camera, "focal_point") and hasattr(camera, "view_angle"):
        eye, target = three(camera.position, "eye"), three(camera.focal_point, "target")
        distance = float(np.linalg.norm(np.subtract(eye, target)))
        flat = bool(camera.parallel_projection)
        height = 2 * (camera.parallel_scale if flat else distance * np.tan(np.radians(camera.view_angle) / 2))
        up = list(three(camera.up, "up"))
        return {"eye": list(eye), "target": list(target), "up": up, "height": float(height), "orthographic": flat}
    raise Error(f"{camera!r} is not a camera", "", 'give "iso", "+x", ..., a dictionary, or a camera of PyVista')


class Frame:
    """One frame of a flow. It is drawn when it is asked for, and can be until the flow makes the next one."""

    def __init__(self, flow: Flow, index: int) -> None:
        self._flow = flow
        self._image: NDArray[np.uint8] | None = None
        self._origin = ""  # how the image came about
        self._changes = flow._changes
        self.index = index  #: from 0
        self.time = flow._native.time()  #: of the data

    def _present(self) -> _core.Flow:
        if self._flow._native.frame() != self.index + 1:
            raise Error(f"frame {self.index} is gone", "the flow has made the next one", "use a frame before you go on")
        return self._flow._native

    @property
    def image(self) -> NDArray[np.uint8]:
        """(height, width, 4): RGBA, row 0 at the top, as the knobs say."""
        if self._image is None or self._changes != self._flow._changes:
            self._changes = self._flow._changes
            self._image, self._origin = self._present().picture(None, None)
        return self._image

    @property
    def values(self) -> FlowCells:
        """The texture as numbers."""
        return FlowCells(**self._present().cells())

    def sample(self, points: ArrayLike) -> NDArray[np.float32]:
        """Values of the texture, 0..1, at (n, 3) points of the surface."""
        return self._present().sample(rows(points, 3, "points", np.float64, finite=True))

    def render(self, camera: Any = None, size: tuple[int, int] | None = None) -> NDArray[np.uint8]:
        """Draw the frame again.

        Parameters
        ----------
        camera : str, dict or camera of PyVista, optional
            "iso", "+x", "-x", "+y", "-y", "+z" or "-z"; or eye, target, height (visible at the target), and perhaps up
            and orthographic, in world coordinates.
        size : (int, int), optional
            Width and height in pixels.
        """
        pixels = None if size is None else (int(size[0]), int(size[1]))
        return self._present().picture(_camera(camera), pixels)[0]

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write the picture (.png) or the values (.vtp; .pvtp: a file for each process, and their list)."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() == ".png":
            image = self.image
            if self._flow._is_first:
                _core.save_picture(path, image, self._origin)
        else:
            self._present().save(path)

    def __reduce__(self) -> NoReturn:
        raise Error("a frame cannot be pickled or copied", "it belongs to a run", "keep its image or its values")

    def __repr__(self) -> str:
        return f"<nacre.Frame: {self.index}, time {self.time:g}>"


class Flow:
    """A flow run: an iterator of `Frame`, with the knobs as attributes.

    Knobs of pictures and filters may be changed at any time. With those of the embedding, `ttl`, `warmup` and `seed`,
    the texture is made again at the time that was reached.
    """

    _native: _core.Flow
    _changes: int
    _is_first: bool  # of several processes, or the only one: it writes pictures

    def __init__(self, core: _core.Flow, is_first: bool = True) -> None:
        self.__dict__.update(_native=core, _changes=0, _is_first=is_first)

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        if not self._native.step():
            raise StopIteration
        return Frame(self, self._native.frame() - 1)

    def __len__(self) -> int:
        return self._native.frames()

    @property
    def report(self) -> dict[str, Any]:
        """Version, device, knobs, input and timings: the report of the program, as a dictionary."""
        report: dict[str, Any] = json.loads(self._native.report())
        return report

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in _FLOW_KNOBS:
            raise AttributeError(f"a flow has no {name!r}")
        return self._native.get(name)

    def __setattr__(self, name: str, value: object) -> None:
        if name not in _FLOW_KNOBS:
            raise AttributeError(f"no knob {name!r}; nacre.knobs('flow') lists them")
        self._native.set(name, knob(name, value))
        self.__dict__["_changes"] = self._changes + 1

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_FLOW_KNOBS]

    def __reduce__(self) -> NoReturn:
        raise Error("a flow cannot be pickled or copied", "", "keep what its frames give: images, values")

    def __repr__(self) -> str:
        return f"<nacre.Flow: frame {self._native.frame()} of {len(self)}>"


_FLOW_KNOBS = frozenset(each["name"] for each in _core.knobs("flow"))


def _per_point(values: Any, n: int, width: int, what: str) -> NDArray[np.float32]:
    array = real_array(values, what)
    shape = (n,) if width == 1 else (n, width)
    if array.shape != shape:
        raise Error(f"{what} has shape {array.shape}", "", f"it must be {shape}: one row per point")
    return np.ascontiguousarray(array, dtype=np.float32)


def _times(
    times: Any,
    steps: int | None,
    missing: str = "a velocity that is a function of time needs times",
    what: str = "velocity",
) -> list[float]:
    if times is None:
        if steps is None:
            raise Error(missing, "", "give times=numpy.linspace(0, 1, 21)")
        return [float(k) for k in range(steps)]
    array = real_array(times, "times").reshape(-1)
    if steps is not None and len(array) != steps:
        raise Error(f"there are {len(array)} times and {steps} steps of {what}")
    return [float(t) for t in array]


Steps = Callable[[int], NDArray[np.float32]]


def _points(points: Any, times: Any) -> tuple[NDArray[np.float64], Any, Callable[[int], NDArray[np.float64]] | None]:
    """The points of the first time, the times, and the function that gives the points of each."""
    if callable(points):
        moments = _times(times, None, "points that are a function of time need times")
        first = rows(points(moments[0]), 3, "points", np.float64)
        return first, moments, lambda k: _points_at(points(moments[k]), len(first))
    array = np.asarray(points)
    if array.ndim != 3:
        return rows(points, 3, "points", np.float64), times, None
    if array.shape[0] == 0:
        raise Error(f"points have shape {array.shape}", "", "they must be (n, 3), or (steps, n, 3)")
    moments = _times(times, array.shape[0], what="points")
    first = rows(array[0], 3, "points", np.float64)
    return first, moments, lambda k: _points_at(array[k], len(first))


def _points_at(points: Any, n: int) -> NDArray[np.float64]:
    array = rows(points, 3, "points", np.float64)
    if len(array) != n:
        raise Error(f"there are {len(array)} points at one time and {n} at another", "", "they must be the same points")
    return np.ascontiguousarray(array)


def _velocity(velocity: Any, times: Any, n: int, moves: bool) -> tuple[Steps | None, list[float], str | None]:
    """The function that gives a step, the times, and the name of an analytic field."""
    if isinstance(velocity, str):
        return None, _times(times, 1 if times is None else None), velocity
    if callable(velocity):
        moments = _times(times, None)
        return (lambda k: _per_point(velocity(moments[k]), n, 3, "the velocity")), moments, None
    array = real_array(velocity, "velocity")
    if array.ndim == 2:
        steps = np.size(times) if moves else 1  # where points move, one velocity may be that of all times
        array = np.broadcast_to(array, (steps, *array.shape))
    if array.ndim != 3 or array.shape[1:] != (n, 3) or array.shape[0] == 0:
        advice = f"it must be ({n}, 3), or (steps, {n}, 3): one row per point"
        raise Error(f"velocity has shape {np.shape(velocity)}", "", advice)
    return (lambda k: _per_point(array[k], n, 3, "velocity")), _times(times, array.shape[0]), None


def _mesh_of(surface: Any) -> tuple[Any, Any]:
    """Points and triangles of a vtkPolyData or pyvista.PolyData."""
    import importlib

    numpy_support = importlib.import_module("vtkmodules.util.numpy_support")
    filters = importlib.import_module("vtkmodules.vtkFiltersCore")
    cut = filters.vtkTriangleFilter()
    cut.SetInputData(surface)
    cut.PassLinesOff()
    cut.PassVertsOff()
    cut.Update()
    polys = cut.GetOutput().GetPolys()
    if surface.GetPoints() is None or polys.GetNumberOfCells() == 0:
        raise Error("the surface has no triangles")
    corners = numpy_support.vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3)
    return numpy_support.vtk_to_numpy(cut.GetOutput().GetPoints().GetData()), corners


def _array_of(surface: Any, name: str) -> Any:
    import importlib

    numpy_support = importlib.import_module("vtkmodules.util.numpy_support")
    array = surface.GetPointData().GetArray(name)
    if array is None:
        known = [surface.GetPointData().GetArrayName(k) for k in range(surface.GetPointData().GetNumberOfArrays())]
        raise Error(f"the surface has no point array {name!r}", f"it has {known}")
    return numpy_support.vtk_to_numpy(array)


@dataclass(frozen=True)
class FlowInput:
    """What a flow run begins from, checked."""

    points: NDArray[np.float64]  #: at the first time
    positions: Callable[[int], NDArray[np.float64]] | None  #: by number of time; None: the surface stands still
    triangles: NDArray[np.int64]
    times: list[float]
    vectors: Steps | None  #: by number of time; None: the analytic field `title`
    scalar: Callable[[str, int], NDArray[np.float32]]
    scalar_names: list[str]
    title: str


def flow_input(
    points: Any,
    triangles: Any,
    velocity: Any,
    times: Any = None,
    scalars: Mapping[str, Any] | None = None,
    title: str | None = None,
    color: object = None,
) -> FlowInput:
    """The arguments of `flow`, checked; `color` is the scalar that is taken from a PolyData."""
    if hasattr(points, "GetPolys"):
        surface = points
        points, own = _mesh_of(surface)
        triangles = own if triangles is None else triangles
        if isinstance(velocity, str) and not velocity.startswith("@"):
            title = velocity if title is None else title
            velocity = _array_of(surface, velocity)
        if color not in (None, "speed", "none") and scalars is None:
            scalars = {str(color): _array_of(surface, str(color))}
    if triangles is None or velocity is None:
        raise Error("the surface needs triangles and a velocity", "", "nacre.flow(points, triangles, velocity)")
    first, times, positions = _points(points, times)
    corners = rows(triangles, 3, "triangles", np.int64)
    n = len(first)
    vectors, moments, analytic = _velocity(velocity, times, n, positions is not None)
    numbers = {str(key): real_array(value, f"scalars {key!r}") for key, value in (scalars or {}).items()}
    for key, array in numbers.items():
        if array.shape not in ((n,), (len(moments), n)):
            raise Error(f"scalars {key!r} has shape {array.shape}", "", f"it must be ({n},) or ({len(moments)}, {n})")

    def scalar(key: str, step: int) -> NDArray[np.float32]:
        array = numbers[key]
        return np.ascontiguousarray(array if array.ndim == 1 else array[step], dtype=np.float32)

    title = analytic or title or "velocity"
    if analytic is None and title.startswith("@"):
        raise Error(f"no vectors may be called {title!r}", "names with @ are those of analytic fields")
    return FlowInput(first, positions, corners, moments, vectors, scalar, list(numbers), title)


def flow(
    points: Any,
    triangles: Any = None,
    velocity: Any = None,
    *,
    times: ArrayLike | None = None,
    scalars: Mapping[str, Any] | None = None,
    name: str = "surface",
    vector_name: str | None = None,
    device: str = "auto",
    threads: int = 0,
    progress: Progress | None = None,
    comm: Any = None,
    **knobs: Unpack[FlowKnobs],
) -> Flow:
    """Show unsteady flow on a surface as a moving texture.

    Parameters
    ----------
    points : (n, 3) array, (steps, n, 3) array, callable, or pyvista.PolyData or vtkPolyData
        The surface; of a PolyData, `triangles` are its own, and `velocity` may be the name of a point array. With steps,
        or as a function of time that returns (n, 3), it moves: the texture stays with the material, and velocities are
        shown relative to the surface (knob `relative`).
    triangles : (k, 3) array
        Corners of triangles, numbers of points from 0.
    velocity : (n, 3) array, (steps, n, 3) array, callable or str
        Vectors at the points, in units of length per unit of time: steady, or at `times`; a function of time that
        returns (n, 3), called once or more for each of `times`; or "@swirl" or "@rotation". Between two times they are
        interpolated linearly. Only their part in the surface is shown.
    times : (steps,) array, optional
        Ascending; 0, 1, 2, ... where they are left out.
    scalars : dict, optional
        Arrays (n,) or (steps, n) by name, for the knob `color`.
    name, vector_name : str
        What messages, legend and report call the surface and its vectors.
    device : str
        "cpu", "cuda" or "cuda:N"; "auto": a GPU where one can be used.
    threads : int
        Threads of the CPU; 0: all. Results do not depend on it.
    progress : callable, optional
        progress(stage, fraction, iteration, particles, energy); the run stops where it returns False or raises.
    comm : mpi4py.MPI.Intracomm, optional
        The processes that make the run together, with `method="octree"`; results do not depend on how many there are.
        All of them make the same calls with the same arguments, and get the same images and samples; `values` are each
        one's own cells. `threads=0`: a fair share of the machine for each. Start with `mpirun -n 4 python -m mpi4py
        script.py`: then an exception in one process ends all.
    **knobs
        See below.

    Returns
    -------
    Flow
        An iterator of `steps` frames.
    """
    given = flow_input(points, triangles, velocity, times, scalars, vector_name, knobs.get("color"))
    if progress is not None and not callable(progress):
        raise Error("progress is no function")
    processes = None if comm is None else Processes(comm)
    if processes is not None and threads == 0:
        threads = processes.threads()
    core = _core.Flow(
        given.points,
        given.triangles,
        given.times,
        given.positions,
        given.vectors,
        given.scalar,
        given.scalar_names,
        str(name),
        given.title,
        knob_dict(knobs),
        str(device),
        int(threads),
        progress,
        processes,
    )
    return Flow(core, is_first=processes is None or processes.rank == 0)
