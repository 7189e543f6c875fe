# Nacre: the window of the program, for data of Python.
"""The window of the program, for data of Python."""

from __future__ import annotations

import atexit
import os
import re
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import knob_dict
from ._errors import Error
from ._flow import flow_input
from ._images import volume_dict, volumes_of

_NRRD_TYPES = {"u1": "uint8", "i1": "int8", "u2": "uint16", "i2": "int16", "u4": "uint32", "i4": "int32"}
_NRRD_TYPES |= {"u8": "uint64", "i8": "int64", "f4": "float", "f8": "double"}


def _one_line(text: str) -> str:
    return " ".join(text.split())


def write_volume(file: Path, volume: Mapping[str, Any]) -> None:
    """A volume as `volume_dict` gives it, as NRRD with the names of its labels."""
    values: NDArray[Any] = volume["values"]
    little = values.astype(values.dtype.newbyteorder("<"), copy=False)
    steps = (np.asarray(volume["axes"]) * np.asarray(volume["spacing"])[:, None]).tolist()
    vectors = ["(" + ",".join(repr(float(x)) for x in row) + ")" for row in [*steps, volume["origin"]]]
    lines = [
        "NRRD0004",
        f"type: {_NRRD_TYPES[values.dtype.str[1:]]}",
        "dimension: 3",
        "space dimension: 3",
        "sizes: " + " ".join(str(n) for n in values.shape[::-1]),
        "space directions: " + " ".join(vectors[:3]),
        f"space origin: {vectors[3]}",
        "endian: little",
        "encoding: raw",
    ]
    for k, (label, name) in enumerate(volume["names"].items()):
        lines += [f"Segment{k}_Name:={_one_line(name)}", f"Segment{k}_LabelValue:={label}"]
    with open(file, "wb") as out:
        out.write("\n".join(lines).encode() + b"\n\n")
        out.write(little.tobytes())


def _write_surface(
    file: Path, points: NDArray[np.float64], triangles: NDArray[np.int64], arrays: Mapping[str, NDArray[np.float32]]
) -> None:
    """A .vtp with its arrays appended as they are."""
    from xml.sax.saxutils import quoteattr

    blocks: list[bytes] = []

    def entry(name: str, kind: str, values: NDArray[Any], components: int) -> str:
        data = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes()
        offset = sum(map(len, blocks))
        blocks.append(len(data).to_bytes(8, "little") + data)
        return (
            f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{components}" '
            f'format="appended" offset="{offset}"/>'
        )

    data = "".join(entry(name, "Float32", v, 3 if v.ndim == 2 else 1) for name, v in arrays.items())
    positions = entry("Points", "Float64", points, 3)
    corners = entry("connectivity", "Int64", triangles, 1)
    ends = entry("offsets", "Int64", np.arange(1, len(triangles) + 1, dtype=np.int64) * 3, 1)
    head = (
        '<?xml version="1.0"?><VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        f'<PolyData><Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(triangles)}"><PointData>{data}</PointData>'
        f"<Points>{positions}</Points><Polys>{corners}{ends}</Polys></Piece></PolyData>"
        '<AppendedData encoding="raw">_'
    )
    file.write_bytes(head.encode() + b"".join(blocks) + b"</AppendedData></VTKFile>")


def _write_flow(folder: Path, points: Any, triangles: Any, velocity: Any, times: Any, scalars: Any) -> tuple[Path, str]:
    """The file to open, and what its vectors are called."""
    given = flow_input(points, triangles, velocity, times, scalars)
    file = folder / "surface.pvd"
    steps = []
    for k, time in enumerate(given.times):
        arrays = {name: given.scalar(name, k) for name in given.scalar_names}
        if given.vectors is not None:
            arrays[given.title] = given.vectors(k)
        name = f"surface_{k}.vtp"
        points_then = given.points if given.positions is None else given.positions(k)
        _write_surface(folder / name, points_then, given.triangles, arrays)
        steps.append(f'<DataSet timestep="{time!r}" file="{name}"/>')
    file.write_text(f'<VTKFile type="Collection" version="1.0"><Collection>{"".join(steps)}</Collection></VTKFile>')
    return file, given.title


def _find_program(program: str | os.PathLike[str] | None) -> str:
    chosen = os.fspath(program) if program is not None else os.environ.get("NACRE_PROGRAM") or shutil.which("nacre")
    advice = "install the program, or give program= or the environment variable NACRE_PROGRAM"
    if not chosen:
        raise Error("the program nacre is not on the path", "the module has no window of its own", advice)
    try:
        said = subprocess.run([chosen, "--version"], capture_output=True, text=True, timeout=60).stdout
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Error(f"{chosen} cannot be run", str(error), advice) from error
    if not re.match(r"nacre \d+\.\d+", said):
        raise Error(f"{chosen} is another program than Nacre's", _one_line(said)[:80], advice)
    return chosen


_open: set[View] = set()


class View:
    """A window of the program. It closes with the interpreter, unless that waits for it."""

    def __init__(self, command: Sequence[str], folder: Path) -> None:
        self._folder = folder
        self._errors = open(folder / "errors.txt", "w+b")
        try:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self._errors
            )
        except BaseException:
            self._errors.close()
            shutil.rmtree(folder, ignore_errors=True)
            raise
        self._said = ""
        self._cleaned = threading.Event()
        _open.add(self)
        threading.Thread(target=self._clean, daemon=True).start()

    def _clean(self) -> None:
        self._process.wait()
        self._errors.seek(0)
        self._said = self._errors.read().decode(errors="replace")
        self._errors.close()
        shutil.rmtree(self._folder, ignore_errors=True)
        _open.discard(self)
        self._cleaned.set()

    @property
    def running(self) -> bool:
        """Whether the window is open."""
        return not self._cleaned.is_set()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the window is closed; False after `timeout` seconds. Raises Error if the program failed."""
        if not self._cleaned.wait(timeout):
            return False
        if self._process.returncode > 0 and self._process.returncode != 130:
            lines = [line for line in self._said.splitlines() if line.strip()]
            raise Error("the window could not be shown", lines[-1] if lines else f"status {self._process.returncode}")
        return True

    def close(self) -> None:
        """Close the window."""
        if self._process.poll() is None:
            self._process.terminate()
            if not self._cleaned.wait(10):
                self._process.kill()
        self._cleaned.wait(10)

    def __repr__(self) -> str:
        return f"<nacre.View: {'open' if self.running else 'closed'}>"


@atexit.register
def _close_all() -> None:
    for each in list(_open):
        each.close()


def _write_volumes(folder: Path, data: Any, geometry: Mapping[str, Any]) -> list[str]:
    files = []
    for k, image in enumerate(volumes_of(data)):
        file = folder / f"volume{k if k else ''}.seg.nrrd"
        write_volume(file, volume_dict(image, **geometry))
        files.append(str(file))
    return files


def view(
    data: Any,
    triangles: Any = None,
    velocity: Any = None,
    *,
    times: Any = None,
    scalars: Mapping[str, Any] | None = None,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    order: str = "zyx",
    names: Mapping[int, str] | None = None,
    program: str | os.PathLike[str] | None = None,
    block: bool = False,
    **knobs: object,
) -> View:
    """Open the window of the program: `nacre view`, where that is installed.

    The data go to it through temporary files, which are removed when it is closed.

    Parameters
    ----------
    data : path, volume or surface
        A file that the program reads; what `nacre.mesh` takes (an array or image, or a list of them); or, with
        `triangles` and `velocity`, or as a PolyData, what `nacre.flow` takes.
    triangles, velocity, times, scalars
        As for `nacre.flow`.
    spacing, origin, direction, order, names
        As for `nacre.mesh`.
    program : path, optional
        The program; else the environment variable NACRE_PROGRAM, else `nacre` on the path.
    block : bool
        Wait until the window is closed.
    **knobs
        Those of `nacre.mesh` or `nacre.flow`.

    Returns
    -------
    View
        With `running`, `wait()` and `close()`.
    """
    known = {each["name"] for job in ("mesh", "flow") for each in _core.knobs(job)}
    for name in knobs:
        if name not in known:
            raise Error(f"no knob {name!r}", "", "nacre.knobs('mesh') and nacre.knobs('flow') list them")
    chosen = _find_program(program)
    folder = Path(tempfile.mkdtemp(prefix="nacre-view-"))
    try:
        options = knob_dict(knobs)
        if isinstance(data, (str, os.PathLike)):
            files = [os.fspath(data)]
        elif triangles is not None or velocity is not None or hasattr(data, "GetPolys"):
            file, title = _write_flow(folder, data, triangles, velocity, times, scalars)
            files = [str(file)]
            options.setdefault("vectors", title)
        else:
            geometry = {"spacing": spacing, "origin": origin, "direction": direction, "order": order, "names": names}
            files = _write_volumes(folder, data, geometry)
        words = [f"{name}={str(value).lower() if isinstance(value, bool) else value}" for name, value in options.items()]
        command = [chosen, "view", *files, *(word for each in words for word in ("--set", each))]
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    window = View(command, folder)
    window.wait(None if block else 0.5)  # what fails at once is told at once
    return window
