# Nacre: volumes to meshes.
"""Volumes of labels, indicator functions or scalars to conformal meshes."""

from __future__ import annotations

import copy
import json
import os
import weakref
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import knob, knob_dict
from ._errors import Error, give_warning
from ._images import volume_dict, volumes_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._knobs import MeshKnobs

#: Told of stage, fraction of the whole job, iteration, particles and their mean energy; False stops the run.
Progress = Callable[[str, float, int, int, float], object]


@dataclass(frozen=True)
class Quality:
    """How good the triangles of a mesh are. Angles in degrees, distances in voxels (the smallest spacing)."""

    radius_ratio_mean: float  #: of triangles, 2 r_in / r_circ: 1 where equilateral
    radius_ratio_min: float
    angle_min: float
    angle_max: float
    distance_mean: float  #: of centres of triangles from the interface that they stand for
    distance_max: float
    sound: bool  #: closed, oriented, manifold off the junctions, nothing doubled or without area
    lost_labels: list[int]  #: labels without a surface
    flaws: list[str]  #: what is wrong, with advice; empty: nothing


@dataclass(frozen=True)
class Particles:
    """Particles on the interfaces, one row each; lengths in world units."""

    points: NDArray[np.float64]  #: (n, 3)
    size: NDArray[np.float32]  #: (n,) distance to keep from neighbours
    energy: NDArray[np.float32]  #: (n,)
    normal: NDArray[np.float32]  #: (n, 3) of the surface; tangent of a curve; zero at a junction point
    order: NDArray[np.uint8]  #: (n,) 0 at junction points, 1 on junction curves, 2 on surfaces

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` of points with their arrays."""
        pyvista = _package("pyvista")
        cloud = pyvista.PolyData(self.points)
        for name in ("size", "energy", "normal", "order"):
            cloud.point_data[name] = getattr(self, name)
        return cloud


def _package(name: str) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Error(f"{name} is not installed", "", f"pip install {name}") from error


def _add_names(dataset: Any, names: Mapping[int, str]) -> None:
    """Names of labels as two field arrays, which every VTK format keeps."""
    if names:
        dataset.field_data["material_labels"] = np.array(list(names), dtype=np.int64)
        dataset.field_data["material_names"] = list(names.values())


class Tetrahedra:
    """The insides of the materials, filled. The facets between them are exactly the triangles of the mesh."""

    def __init__(self, mesh: Mesh, data: dict[str, Any]) -> None:
        self._mesh = mesh
        self._material: NDArray[np.uint16] = data["material"]
        self.points: NDArray[np.float64] = data["points"]  #: (n, 3), the corners of the mesh first, points on edges last
        #: (k, 4), positive volume; of second order (k, 10): then the points on the edges 01 12 20 03 13 23, as in VTK
        self.cells: NDArray[np.int64] = data["cells"]
        if len(data["midsides"]):
            self.cells = np.hstack([self.cells, data["midsides"]])
        labels = np.array([label for label, _ in mesh._materials], dtype=np.int64)
        self.labels: NDArray[np.int64] = labels[self._material]  #: (k,) the label of each cell

    @property
    def names(self) -> dict[int, str]:
        """Names of labels, where known."""
        return self._mesh.names

    @property
    def order(self) -> int:
        """2 where cells have points on their edges, else 1."""
        return 2 if self.cells.shape[1] == 10 else 1

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write cells, and the triangles where the format has a place for them; `nacre.volume_extensions`."""
        m = self._mesh
        corners, midsides = (np.ascontiguousarray(part) for part in (self.cells[:, :4], self.cells[:, 4:]))
        if self.order == 1:
            midsides = np.empty((0, 6), np.int64)
        border = m.points[: m._corners]  # the mesh may be of another order
        _core.save_cells(
            os.fspath(file), border, m.triangles, m._sides, m._materials, self.points, corners, self._material, midsides,
            m._origin,
        )

    def to_pyvista(self) -> Any:
        """A `pyvista.UnstructuredGrid` with the cell array `material`: labels."""
        pyvista = _package("pyvista")
        kind = pyvista.CellType.QUADRATIC_TETRA if self.order == 2 else pyvista.CellType.TETRA
        grid = pyvista.UnstructuredGrid({kind: self.cells}, self.points)
        grid.cell_data["material"] = self.labels
        _add_names(grid, self.names)
        return grid

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` with the cell data `material`."""
        meshio = _package("meshio")
        kind = "tetra10" if self.order == 2 else "tetra"
        return meshio.Mesh(self.points, [(kind, self.cells)], cell_data={"material": [self.labels]})

    def __repr__(self) -> str:
        return f"<nacre.Tetrahedra: {len(self.cells)} cells, {len(self.points)} points>"


class Mesh:
    """The interfaces of all materials as one conformal mesh of triangles, in world coordinates."""

    def __init__(self, run: Meshing | None, data: dict[str, Any]) -> None:
        self._run = run
        self._changes = 0 if run is None else run._changes
        self._kept: tuple[Quality, dict[str, Any]] | None = None  # of a pickled mesh
        self._take(data)

    def _take(self, data: dict[str, Any]) -> None:
        self._data = data
        self._materials: list[tuple[int, str]] = data["materials"]
        self._sides: NDArray[np.uint16] = data["sides"]
        self._origin: str = data.get("origin", "")
        self.points: NDArray[np.float64] = data["points"]  #: (n, 3), points on edges last
        #: (k, 3); counter-clockwise as seen from the side of `materials[:, 0]`
        self.triangles: NDArray[np.int64] = data["triangles"]
        midsides: NDArray[np.int64] = data["midsides"]
        #: (k, 3) with the knob `element_order` 2, the points on the edges 01 12 20; else None
        self.midsides: NDArray[np.int64] | None = midsides if len(midsides) else None
        self._corners = int(midsides.min()) if len(midsides) else len(self.points)
        labels = np.array([label for label, _ in self._materials], dtype=np.int64)
        self.materials: NDArray[np.int64] = labels[self._sides]  #: (k, 2) the labels on the two sides

    @property
    def outside(self) -> int:
        """The label of what is not meshed."""
        return self._materials[0][0]

    @property
    def labels(self) -> list[int]:
        """The labels of the materials, without the outside."""
        return [label for label, _ in self._materials[1:]]

    @property
    def names(self) -> dict[int, str]:
        """Names of labels, where known."""
        return {label: name for label, name in self._materials if name}

    def _live_run(self) -> Meshing:
        if self._run is None:
            raise Error("this mesh was pickled, and its run was not", "", "fill it before, and pickle the tetrahedra too")
        if self._changes != self._run._changes:
            raise Error("the run that made this mesh has gone on", "a knob was changed", "ask the run's new mesh")
        return self._run

    def tetrahedra(self, max_cell: float | None = None, order: int | None = None) -> Tetrahedra:
        """Fill every material but the outside.

        Only facets of Delaunay cells can be filled. A mesh of stars (the knob `triangulation`) is triangulated anew, from
        the same particles: this mesh has the new triangles and points then.

        Parameters
        ----------
        max_cell : float, optional
            Longest edge of the tetrahedra, in voxels (the smallest spacing); 0: they grow with the distance from the
            surface. None: as the knob of the run says.
        order : int, optional
            2: with a point on each edge, which lies on the interface where the edge belongs to one, or nearer to the
            edge where a cell would be turned inside out; 1: straight. None: as the knob `element_order` of the run says.
        """
        run = self._live_run()
        if order is not None:
            run._native.set("element_order", knob("order", order))
        if max_cell is not None:
            run._native.set("max_cell", knob("max_cell", max_cell))
        cells, anew = run._native.tetrahedra()
        if anew is not None:
            self._take(anew)
        return Tetrahedra(self, cells)

    @property
    def quality(self) -> Quality:
        """Shape of the triangles, their distance from the interfaces, and whether the mesh is sound."""
        if self._kept is not None:
            return self._kept[0]
        return Quality(**self._live_run()._native.quality())

    @property
    def report(self) -> dict[str, Any]:
        """Version, device, knobs, input, timings and measures: the report of the program, as a dictionary."""
        if self._kept is not None:
            return copy.deepcopy(self._kept[1])
        report: dict[str, Any] = json.loads(self._live_run()._native.report())
        return report

    def save(self, file: str | os.PathLike[str], surface_only: bool = False) -> None:
        """Write the mesh in the format of the file's extension.

        Formats of tetrahedra (`nacre.volume_extensions`) get the mesh filled with tetrahedra, unless `surface_only`;
        formats of surfaces (`nacre.surface_extensions`) get the triangles.
        """
        path = os.fspath(file)
        if not surface_only and os.path.splitext(path)[1].lower() in _core.volume_extensions():
            self.tetrahedra().save(path)
        else:
            midsides = np.empty((0, 3), np.int64) if self.midsides is None else self.midsides
            _core.save_mesh(path, self.points, self.triangles, self._sides, self._materials, midsides, self._origin)

    def surface(self, label: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Points and triangles of the closed surface of one material, with normals that point out of it."""
        first, second = self.materials[:, 0] == label, self.materials[:, 1] == label
        if not np.any(first | second):
            raise Error(f"no triangle touches label {label}", "", f"the labels are {self.labels}")
        triangles = np.concatenate([self.triangles[first][:, ::-1], self.triangles[second]])
        used, corners = np.unique(triangles, return_inverse=True)
        return self.points[used], corners.reshape(-1, 3).astype(np.int64)

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with the cell arrays `material_0` and `material_1`: the labels on both sides.

        Its triangles are flat, also those of second order.
        """
        pyvista = _package("pyvista")
        surface = pyvista.PolyData.from_regular_faces(self.points[: self._corners], self.triangles)
        surface.cell_data["material_0"] = self.materials[:, 0]
        surface.cell_data["material_1"] = self.materials[:, 1]
        _add_names(surface, self.names)
        return surface

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` with the cell data `material_0` and `material_1`."""
        meshio = _package("meshio")
        data = {"material_0": [self.materials[:, 0]], "material_1": [self.materials[:, 1]]}
        if self.midsides is None:
            return meshio.Mesh(self.points, [("triangle", self.triangles)], cell_data=data)
        return meshio.Mesh(self.points, [("triangle6", np.hstack([self.triangles, self.midsides]))], cell_data=data)

    def __reduce__(self) -> tuple[Any, ...]:
        """Arrays, quality and report are pickled; the run is not."""
        return _unpickled_mesh, (self._data, (self.quality, self.report))

    def __copy__(self) -> Mesh:
        return self.__deepcopy__({})

    def __deepcopy__(self, memo: dict[int, Any]) -> Mesh:
        """Arrays of its own; the run is the same."""
        twin = Mesh(self._run, {key: copy.copy(value) for key, value in self._data.items()})
        twin._changes, twin._kept = self._changes, self._kept
        return twin

    def __repr__(self) -> str:
        return f"<nacre.Mesh: {len(self.triangles)} triangles, {len(self.points)} points, labels {self.labels}>"


def _unpickled_mesh(data: dict[str, Any], kept: tuple[Quality, dict[str, Any]]) -> Mesh:
    mesh = Mesh(None, data)
    mesh._kept = kept
    return mesh


class Stage:
    """What a mesh run has reached: `name` is "fields", "particles" or "triangles"."""

    def __init__(self, run: Meshing, name: str) -> None:
        self.name = name
        self._run = run

    @property
    def particles(self) -> Particles:
        """Where particles are now; from the stage "particles" on."""
        return self._run.particles

    @property
    def mesh(self) -> Mesh:
        """The mesh; runs what is left to do."""
        return self._run.mesh

    def __repr__(self) -> str:
        return f"<nacre.Stage: {self.name}>"


class Meshing:
    """A mesh run, stage by stage: an iterator of `Stage`, with the knobs as attributes.

    A knob may be changed between stages, and when all are done: iterate again, and the stages that depend on it run
    again. The result is that of a new run, to the byte.
    """

    _native: _core.Meshing
    _changes: int
    _mesh: weakref.ref[Mesh] | None

    def __init__(self, core: _core.Meshing) -> None:
        self.__dict__.update(_native=core, _changes=0, _mesh=None)

    def __iter__(self) -> Iterator[Stage]:
        return self

    def __next__(self) -> Stage:
        if not self._native.advance():
            raise StopIteration
        return Stage(self, self._native.stage())

    @property
    def stage(self) -> str:
        """The last that is done: "materials", "fields", "particles" or "triangles"."""
        return self._native.stage()

    @property
    def particles(self) -> Particles:
        """Where particles are now; from the stage "particles" on."""
        return Particles(**self._native.particles())

    @property
    def mesh(self) -> Mesh:
        """The mesh; runs what is left to do."""
        made = None if self._mesh is None else self._mesh()
        if made is None or made._changes != self._changes:
            made = Mesh(self, self._native.mesh())
            self.__dict__["_mesh"] = weakref.ref(made)  # the mesh holds the run
        return made

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in _MESH_KNOBS:
            raise AttributeError(f"a mesh run has no {name!r}")
        return self._native.get(name)

    def __setattr__(self, name: str, value: object) -> None:
        if name not in _MESH_KNOBS:
            raise AttributeError(f"no knob {name!r}; nacre.knobs('mesh') lists them")
        self._native.set(name, knob(name, value))
        self.__dict__["_changes"] = self._changes + 1

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_MESH_KNOBS]

    def __reduce__(self) -> NoReturn:
        raise Error("a mesh run cannot be pickled or copied", "", "pickle its mesh, which leaves the run behind")


_MESH_KNOBS = frozenset(each["name"] for each in _core.knobs("mesh"))


def meshing(
    volume: Any,
    /,
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    order: str = "zyx",
    names: Mapping[int, str] | None = None,
    name: str | None = None,
    device: str = "auto",
    threads: int = 0,
    preset: str = "",
    progress: Progress | None = None,
    **knobs: Unpack[MeshKnobs],
) -> Meshing:
    """Begin a mesh run, to go through it stage by stage. The arguments are those of `nacre.mesh`."""
    volumes = [volume_dict(image, spacing, origin, direction, order, names, name) for image in volumes_of(volume)]
    if progress is not None and not callable(progress):
        raise Error("progress is no function")
    return Meshing(_core.Meshing(volumes, knob_dict(knobs), str(device), int(threads), str(preset), progress))


def mesh(
    volume: Any,
    /,
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    order: str = "zyx",
    names: Mapping[int, str] | None = None,
    name: str | None = None,
    device: str = "auto",
    threads: int = 0,
    preset: str = "",
    progress: Progress | None = None,
    **knobs: Unpack[MeshKnobs],
) -> Mesh:
    """Make a conformal mesh of a volume.

    Parameters
    ----------
    volume : array or image, or a list of them
        Labels (any whole numbers), or scalars to be cut at `isovalue`; of several, each is the indicator function of one
        material. A numpy array has z first and x last, unless `order` says otherwise. Images of SimpleITK, nibabel,
        pynrrd (the pair that `nrrd.read` returns), VTK and PyVista bring their spacing, origin and direction.
    spacing : three numbers, optional
        Distance of voxels along x, y and z (in this order, whatever the order of the array), in the unit of the result.
    origin : three numbers, optional
        Where the centre of the first voxel is.
    direction : (3, 3) array, optional
        Its columns are the directions of x, y and z in the world: unit vectors at right angles.
    order : {"zyx", "xyz"}
        Which axis of an array comes first. Images know it themselves.
    names : dict, optional
        Names of labels; they go into files and reports.
    name : str, optional
        What messages and the report call the volume.
    device : str
        "cpu", "cuda" or "cuda:N"; "auto": a GPU where one can be used.
    threads : int
        Threads of the CPU; 0: all. Results do not depend on it.
    preset : {"", "source"}
        "source": the constants of the thesis.
    progress : callable, optional
        progress(stage, fraction, iteration, particles, energy); the run stops where it returns False or raises.
    **knobs
        See below. Lengths in voxels are multiples of the smallest spacing.

    Returns
    -------
    Mesh

    Raises
    ------
    Error
        For bad input, with what is wrong, why, and what to do.
    Interrupted
        Where `progress` returned False.
    """
    run = meshing(
        volume,
        spacing=spacing,
        origin=origin,
        direction=direction,
        order=order,
        names=names,
        name=name,
        device=device,
        threads=threads,
        preset=preset,
        progress=progress,
        **knobs,
    )
    result = run.mesh
    for flaw in result.quality.flaws:
        give_warning(flaw)
    return result
