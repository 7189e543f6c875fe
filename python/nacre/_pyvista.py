# Nacre: what PyVista finds by its entry points: an accessor, and writers and readers of files.
"""What PyVista (0.48 or later) finds by its entry points.

`dataset.nacre` is there once the module is installed; nothing has to be imported. `dataset.save("liver.inp")` writes
labelled tetrahedra for solvers, and `pyvista.read("aseg.mgz")` reads volumes of FreeSurfer.
"""

from __future__ import annotations

import gzip
import importlib
import os
import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._errors import Error
from ._flow import Flow, _mesh_of, flow
from ._mesh import Mesh, Meshing, mesh, meshing
from ._tetrahedra import save_tetrahedra
from ._view import View, view

pyvista: Any = importlib.import_module("pyvista")


class ImageAccessor:
    """`image.nacre`: meshes of a `pyvista.ImageData` with one label or number per voxel."""

    def __init__(self, image: Any) -> None:
        self._image = image

    def run(self, **options: Any) -> Mesh:
        """`nacre.mesh` of the image, with its keywords."""
        return mesh(self._image, **options)

    def meshing(self, **options: Any) -> Meshing:
        """`nacre.meshing` of the image: stage by stage."""
        return meshing(self._image, **options)

    def mesh(self, **options: Any) -> Any:
        """The interfaces as a `PolyData` with the cell arrays `material_0` and `material_1`."""
        return self.run(**options).to_pyvista()

    def tetrahedra(self, **options: Any) -> Any:
        """The materials, filled, as an `UnstructuredGrid` with the cell array `material`."""
        return self.run(**options).tetrahedra().to_pyvista()

    def view(self, **options: Any) -> View:
        """`nacre.view` of the image: the window of the program."""
        return view(self._image, **options)


class SurfaceAccessor:
    """`surface.nacre`: flow on a `pyvista.PolyData`, and its closest points."""

    def __init__(self, surface: Any) -> None:
        self._surface = surface

    def flow(self, velocity: Any, **options: Any) -> Flow:
        """`nacre.flow` on the surface; `velocity` is the name of a point array, or what `nacre.flow` takes."""
        return flow(self._surface, velocity=velocity, **options)

    def closest_points(self, queries: ArrayLike) -> Any:
        """`nacre.closest_points` of the surface."""
        from . import closest_points

        return closest_points(*_mesh_of(self._surface), queries)

    def view(self, velocity: Any, **options: Any) -> View:
        """`nacre.view` of the surface with its flow: the window of the program."""
        return view(self._surface, velocity=velocity, **options)


class GridAccessor:
    """`grid.nacre`: files for solvers of a `pyvista.UnstructuredGrid` of tetrahedra."""

    def __init__(self, grid: Any) -> None:
        self._grid = grid

    def save(self, file: str | os.PathLike[str], labels: str = "") -> None:
        """`nacre.save_tetrahedra`; `labels` is a cell array, else "material" where there is one."""
        write(self._grid, os.fspath(file), labels=labels)


pyvista.register_dataset_accessor("nacre", pyvista.ImageData)(ImageAccessor)
pyvista.register_dataset_accessor("nacre", pyvista.PolyData)(SurfaceAccessor)
pyvista.register_dataset_accessor("nacre", pyvista.UnstructuredGrid)(GridAccessor)


def _names_of(dataset: Any) -> dict[int, str]:
    if "material_names" not in dataset.field_data or "material_labels" not in dataset.field_data:
        return {}
    numbers, names = dataset.field_data["material_labels"], dataset.field_data["material_names"]
    return {int(number): str(name) for number, name in zip(numbers, names)}


def write(dataset: Any, path: str, labels: str = "") -> None:
    """Write an `UnstructuredGrid` of tetrahedra for a solver; the entry point of PyVista's `save`."""
    if not hasattr(dataset, "cells_dict"):
        raise Error(f"a {type(dataset).__name__} has no tetrahedra", "", "save an UnstructuredGrid of tetrahedra")
    kinds = set(np.unique(dataset.celltypes).tolist())
    tetra = int(pyvista.CellType.TETRA)
    if tetra not in kinds:
        raise Error("the grid has no linear tetrahedra", f"its cells are of the types {sorted(kinds)}")
    if kinds != {tetra}:
        raise Error("the grid has other cells beside tetrahedra", "", "extract_cells_by_type(pyvista.CellType.TETRA)")
    name = labels or ("material" if "material" in dataset.cell_data else "")
    if name and name not in dataset.cell_data:
        raise Error(f"the grid has no cell array {name!r}", f"it has {list(dataset.cell_data)}")
    label = dataset.cell_data[name] if name else None
    save_tetrahedra(path, dataset.points, dataset.cells_dict[tetra], label, _names_of(dataset))


_MGH_TYPES = {0: ">u1", 1: ">i4", 3: ">f4", 4: ">i2", 10: ">u2"}


def read(path: str, **_: Any) -> Any:
    """Read a volume of FreeSurfer (.mgz, .mgh) as `ImageData`; the entry point of PyVista's `read`."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:2] == b"\x1f\x8b":
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError) as error:
            raise Error(f"cannot read {path}", str(error)) from error
    if len(data) < 284:
        raise Error(f"cannot read {path}", "it is too short for a volume of FreeSurfer")
    version, x, y, z, frames, kind = struct.unpack(">6i", data[:24])
    (good,) = struct.unpack(">h", data[28:30])
    if version != 1 or kind not in _MGH_TYPES or min(x, y, z, frames) < 1:
        raise Error(f"cannot read {path}", "it is no volume of FreeSurfer")
    if frames != 1:
        raise Error(f"cannot read {path}", f"it has {frames} frames", "give a volume with one")
    dtype, count = np.dtype(_MGH_TYPES[kind]), x * y * z
    if len(data) < 284 + count * dtype.itemsize:
        raise Error(f"cannot read {path}", "it is cut short")
    values = np.frombuffer(data, dtype, count, 284)
    spacing, axes, centre = np.ones(3), np.array([[-1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.zeros(3)
    if good == 1:
        numbers = np.array(struct.unpack(">15f", data[30:90]), float)
        spacing, axes, centre = numbers[:3], numbers[3:12].reshape(3, 3), numbers[12:]
    if not np.all(np.isfinite(axes)) or not np.all(spacing > 0) or not np.all(np.isfinite(centre)):
        raise Error(f"cannot read {path}", "its geometry is damaged")
    origin = centre - (axes * (spacing * (np.array([x, y, z]) / 2))[:, None]).sum(axis=0)
    image = pyvista.ImageData(dimensions=(x, y, z), spacing=spacing, origin=origin)
    image.direction_matrix = axes.T
    image.point_data["labels" if kind != 3 else "values"] = values.astype(dtype.newbyteorder("="))
    return image
