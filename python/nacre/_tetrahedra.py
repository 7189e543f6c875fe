# Nacre: tetrahedra of any origin to files for solvers.
"""Labelled tetrahedra of any origin to files for solvers."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import rows
from ._errors import Error

_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # opposite each corner; normals point out of the cell


def _oriented(points: NDArray[np.float64], cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """The cells with positive volume."""
    corners = points[cells]
    volume = np.linalg.det(corners[:, 1:] - corners[:, :1])
    if np.any(volume == 0) or not np.all(np.isfinite(volume)):
        bad = int(np.flatnonzero((volume == 0) | ~np.isfinite(volume))[0])
        raise Error(f"cell {bad} has no volume", "", "remove flat cells first")
    flipped = cells.copy()
    turned = volume < 0
    flipped[turned, 2], flipped[turned, 3] = cells[turned, 3], cells[turned, 2]
    return flipped


def _interfaces(cells: NDArray[np.int64], material: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.uint16]]:
    """Triangles between different materials, 0 where no cell follows, and their two sides, the lower one first."""
    faces = cells[:, _FACES].reshape(-1, 3)
    owner = np.repeat(material, 4)
    _, which, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    if count.max(initial=0) > 2:
        raise Error("a face belongs to more than two cells", "", "remove cells that are there twice")
    which = which.reshape(-1)
    order = np.lexsort((owner, which))  # of two cells at a face, the one of the higher material is last
    last = np.flatnonzero(np.append(np.diff(which[order]) != 0, True))
    high, low = owner[order[last]], np.zeros(len(last), np.int64)
    shared = count[which[order[last]]] == 2
    low[shared] = owner[order[last[shared] - 1]]
    between = high != low
    sides = np.stack([low, high], axis=1)[between].astype(np.uint16)
    return faces[order[last[between]]], sides


def save_tetrahedra(
    file: str | os.PathLike[str],
    points: ArrayLike,
    cells: ArrayLike,
    labels: ArrayLike | None = None,
    names: Mapping[int, str] | None = None,
) -> None:
    """Write tetrahedra of any origin for a solver: with a group per label, and one per pair of labels that meet.

    Parameters
    ----------
    file : path
        Its extension is one of `nacre.volume_extensions`.
    points : (n, 3) array
    cells : (k, 4) array
        Numbers of points from 0; cells that are turned inside out are turned back.
    labels : (k,) array of whole numbers, optional
        1 for all where they are left out.
    names : dict, optional
        Names of labels.
    """
    positions = rows(points, 3, "points", np.float64, finite=True)
    corners = rows(cells, 4, "cells", np.int64)
    if len(corners) == 0:
        raise Error("there are no tetrahedra")
    if corners.min() < 0 or corners.max() >= len(positions):
        raise Error(f"a cell has a corner outside 0 .. {len(positions) - 1}")
    label = np.ones(len(corners), np.int64) if labels is None else rows(np.reshape(labels, (-1, 1)), 1, "labels", np.int64)
    label = label.reshape(-1)
    if len(label) != len(corners):
        raise Error(f"there are {len(label)} labels and {len(corners)} cells")
    kinds, material = np.unique(label, return_inverse=True)
    material = material.reshape(-1) + 1
    if len(kinds) >= 2**16 - 1:
        raise Error(f"there are {len(kinds)} labels", "", "at most 65534 can be written")
    corners = _oriented(positions, corners)
    triangles, sides = _interfaces(corners, material)
    # Files have the points of the interfaces first.
    is_first = np.zeros(len(positions), bool)
    is_first[triangles] = True
    order = np.concatenate([np.flatnonzero(is_first), np.flatnonzero(~is_first)])
    number = np.empty(len(positions), np.int64)
    number[order] = np.arange(len(positions))
    positions = np.ascontiguousarray(positions[order])
    outside = 0 if 0 not in kinds else int(kinds.min()) - 1
    known = {int(key): str(name) for key, name in (names or {}).items()}
    materials = [(outside, known.get(outside, ""))] + [(int(kind), known.get(int(kind), "")) for kind in kinds]
    border = positions[: int(is_first.sum())]
    straight = np.empty((0, 6), np.int64)
    material = material.astype(np.uint16)
    _core.save_cells(
        os.fspath(file), border, number[triangles], sides, materials, positions, number[corners], material, straight, ""
    )


def tetrahedra_of_meshio(mesh: Any) -> tuple[Any, Any, Any]:
    """Points, tetrahedra and labels of a `meshio.Mesh`."""
    blocks = [k for k, block in enumerate(mesh.cells) if block.type == "tetra"]
    if not blocks:
        raise Error("the mesh has no linear tetrahedra", f"it has {sorted({block.type for block in mesh.cells})}")
    labels = None
    for name in ("material", "gmsh:physical", "medit:ref", "labels"):
        if name in mesh.cell_data:
            labels = np.concatenate([np.reshape(mesh.cell_data[name][k], -1) for k in blocks])
            break
    return mesh.points, np.concatenate([mesh.cells[k].data for k in blocks]), labels


def register_meshio() -> None:
    """Let `meshio.write` write the formats of Nacre that meshio lacks: .feb, .foam and .msh4.

    Cells are tetrahedra; their labels are the cell data "material", or "gmsh:physical". meshio knows no plugins that
    are found by themselves: call this once. It does not change the formats that meshio has.
    """
    import importlib

    try:
        meshio = importlib.import_module("meshio")
    except ImportError as error:
        raise Error("meshio is not installed", "", "pip install meshio") from error

    def write(filename: Any, mesh: Any, **_: Any) -> None:
        points, cells, labels = tetrahedra_of_meshio(mesh)
        names = {int(tag[0]): str(name) for name, tag in mesh.field_data.items() if len(tag) == 2 and int(tag[1]) == 3}
        save_tetrahedra(filename, points, cells, labels, names)

    for name, extension in (("febio", ".feb"), ("openfoam", ".foam"), ("nacre-gmsh4", ".msh4")):
        meshio.register_format(name, [extension], None, {name: write})
