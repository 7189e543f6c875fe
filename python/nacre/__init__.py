# Nacre: meshes from volumes, and flow on surfaces.
"""Nacre: conformal meshes from volumes, and unsteady flow on surfaces.

>>> import nacre
>>> mesh = nacre.mesh(labels, spacing=(0.7, 0.7, 1.25))
>>> for frame in nacre.flow(points, triangles, velocity, times=times): frame.image

`nacre.knobs("mesh")` and `nacre.knobs("flow")` list what can be turned.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import rows as _rows
from ._errors import Error, Interrupted, Warning


from ._levels import load_core as _load_core

_load_core()

from . import _core  # noqa: E402
from ._flow import Flow, FlowCells, Frame, flow  # noqa: E402
from ._mesh import Mesh, Meshing, Particles, Progress, Quality, Stage, Tetrahedra, mesh, meshing  # noqa: E402
from ._tetrahedra import register_meshio, save_tetrahedra  # noqa: E402
from ._view import View, view  # noqa: E402

__version__: str = _core.version

#: Extensions of files, lower case, with dot.
surface_extensions: list[str] = _core.surface_extensions()
volume_extensions: list[str] = _core.volume_extensions()


@dataclass(frozen=True)
class Knob:
    """A parameter of `nacre.mesh` or `nacre.flow`."""

    name: str
    help: str
    unit: str  #: empty: none
    group: str
    default: bool | int | float | str
    min: float  #: of a number
    max: float
    choices: list[str]  #: of a text; empty: any
    live: bool  #: may be changed while a run goes on

    @property
    def values(self) -> str:
        """What it takes, in words."""
        if self.choices:
            return " | ".join(self.choices)
        if isinstance(self.default, bool):
            return "True | False"
        if isinstance(self.default, str):
            return "text"
        return f"{self.min:.10g} .. {self.max:.10g}"


def knobs(job: str) -> list[Knob]:
    """All knobs of a job, "mesh" or "flow"."""
    if job not in ("mesh", "flow"):
        raise Error(f"no job {job!r}", "", 'use "mesh" or "flow"')
    return [Knob(**each) for each in _core.knobs(job)]


class Device(NamedTuple):
    """A processor or GPU; `request` is what the argument `device` takes."""

    request: str
    backend: str
    name: str


def devices() -> list[Device]:
    """What a run can compute on, the CPU first."""
    return [Device(*each) for each in _core.devices()]


class ClosestPoints(NamedTuple):
    """One row per query."""

    points: NDArray[np.float64]  #: (m, 3) on the surface
    triangles: NDArray[np.int64]  #: (m,) that contain them; the first of several
    distance: NDArray[np.float64]  #: (m,) not signed


def closest_points(points: ArrayLike, triangles: ArrayLike, queries: ArrayLike) -> ClosestPoints:
    """The closest points of a surface, exact up to rounding: the embedding itself.

    Parameters
    ----------
    points : (n, 3) array
    triangles : (k, 3) array
        Corners of triangles, numbers of points from 0.
    queries : (m, 3) array
    """
    return ClosestPoints(
        *_core.closest_points(
            _rows(points, 3, "points", np.float64),
            _rows(triangles, 3, "triangles", np.int64),
            _rows(queries, 3, "queries", np.float64),
        )
    )


def _document(function: Any, job: str) -> None:
    """Add the knobs to what help() and editors show."""
    if hasattr(function, "__signature__"):
        return  # the module is loaded again
    lines = ["", "    Knobs", "    -----"]
    signature = inspect.signature(function)
    parameters = [p for p in signature.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    group = ""
    for each in knobs(job):
        if each.group != group:
            group = each.group
            lines.append(f"    {group}:")
        unit = f" [{each.unit}]" if each.unit else ""
        lines.append(f"        {each.name} = {each.default!r} ({each.values}){unit}")
        lines.append(f"            {each.help}")
        parameters.append(inspect.Parameter(each.name, inspect.Parameter.KEYWORD_ONLY, default=each.default))
    function.__doc__ = (function.__doc__ or "").rstrip() + "\n" + "\n".join(lines) + "\n"
    function.__signature__ = signature.replace(parameters=parameters)


for _function, _job in ((mesh, "mesh"), (meshing, "mesh"), (flow, "flow")):
    _document(_function, _job)

__all__ = [
    "ClosestPoints",
    "Device",
    "Error",
    "Flow",
    "FlowCells",
    "Frame",
    "Interrupted",
    "Knob",
    "Mesh",
    "Meshing",
    "Particles",
    "Progress",
    "Quality",
    "Stage",
    "Tetrahedra",
    "View",
    "Warning",
    "closest_points",
    "devices",
    "flow",
    "knobs",
    "mesh",
    "meshing",
    "register_meshio",
    "save_tetrahedra",
    "surface_extensions",
    "view",
    "volume_extensions",
]
