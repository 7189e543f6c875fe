# Nacre: arguments as arrays of the shape, type and order that the compiled part takes.
"""Arguments as arrays of the shape, type and order that the compiled part takes."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import Error


def _from_elsewhere(values: Any) -> Any:
    """Arrays that are not numpy's: by DLPack, without a copy where they are in the CPU's memory; others as they are."""
    if isinstance(values, np.ndarray) or hasattr(values, "__array__") or not hasattr(values, "__dlpack__"):
        return values
    try:
        return np.from_dlpack(values)
    except (BufferError, RuntimeError, TypeError, ValueError):
        return np.from_dlpack(values, device="cpu")  # numpy 2.1 and later: copied from the GPU


def _on_gpu(values: Any) -> bool:
    try:
        device = int(values.__dlpack_device__()[0])
    except Exception:
        return hasattr(values, "__cuda_array_interface__")
    return device != 1


def real_array(values: Any, what: str) -> NDArray[Any]:
    """Numbers of any kind (numpy's, buffers, DLPack); what is no array becomes one."""
    try:
        array = np.asarray(_from_elsewhere(values))
    except Exception as error:
        advice = "copy it to the CPU first: .get() of cupy, .cpu() of torch" if _on_gpu(values) else ""
        raise Error(f"{what} cannot be read as an array", str(error), advice) from error
    if array.dtype.kind not in "buif":
        raise Error(f"{what} holds {array.dtype}, not numbers", "", "give an array of integers or real numbers")
    return array


def rows(values: Any, width: int, what: str, dtype: type, finite: bool = False) -> NDArray[Any]:
    """An (n, width) array, contiguous, of that type."""
    array = real_array(values, what)
    if array.size == 0 and array.ndim <= 2:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise Error(f"{what} has shape {array.shape}", "", f"it must be (n, {width})")
    if np.issubdtype(dtype, np.integer) and array.dtype.kind == "f":
        if not np.all(np.isfinite(array)) or np.any(array != np.floor(array)):
            raise Error(f"{what} holds numbers that are not whole")
    if finite and array.dtype.kind == "f" and not np.all(np.isfinite(array)):
        raise Error(f"{what} holds numbers that are not finite")
    if array.dtype == np.uint64 and array.size and int(array.max()) > np.iinfo(np.int64).max:
        raise Error(f"{what} holds numbers beyond 63 bits")
    return np.ascontiguousarray(array, dtype=dtype)


def three(values: Any, what: str) -> tuple[float, float, float]:
    """Three finite numbers."""
    try:
        numbers = tuple(float(v) for v in np.asarray(values, dtype=float).reshape(-1))
    except (TypeError, ValueError) as error:
        raise Error(f"{what} is {values!r}", "", "it must be three numbers") from error
    if len(numbers) != 3 or not all(math.isfinite(v) for v in numbers):
        raise Error(f"{what} is {values!r}", "", "it must be three finite numbers")
    return numbers[0], numbers[1], numbers[2]


def _text(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        raise Error(f"a knob has a list with {value!r} in it")
    try:
        return str(operator.index(value))  # type: ignore[arg-type]
    except TypeError:
        return repr(float(value))  # type: ignore[arg-type]


def knob(name: str, value: object) -> bool | int | float | str:
    """A knob as the compiled part takes it: lists, pairs and mappings become text."""
    if isinstance(value, (str, bool)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if name == "isovalue" and isinstance(value, (int, float, np.number)):
        return _text(value)
    if name == "materials" and isinstance(value, (int, np.integer)):
        return _text(value)
    try:
        if isinstance(value, Mapping):
            return ",".join(f"{_text(a)}:{_text(b)}" for a, b in value.items())
        if isinstance(value, Iterable):
            between = ":" if name in ("threshold", "time", "color_range") else ","
            return between.join(_text(v) for v in value)
        try:
            number = operator.index(value)  # type: ignore[arg-type]
        except TypeError:
            return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError) as error:
        raise Error(f"{name} is {value!r}", "a knob is a number, a text, true or false, or a list of numbers") from error
    if abs(number) >= 2**63:
        raise Error(f"{name} {number} is out of range")
    return number


def knob_dict(knobs: Mapping[str, object]) -> dict[str, bool | int | float | str]:
    """All knobs of a call; None leaves a knob as it is."""
    return {name: knob(name, value) for name, value in knobs.items() if value is not None}
