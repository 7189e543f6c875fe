"""Which compiled module this processor runs: a wheel has one for each level of the x86-64 instruction set."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import platform
import sys

from . import _build

#: What Linux calls the instructions that a level adds to the one before.
_FLAGS = {
    "x86-64-v2": {"cx16", "popcnt", "ssse3", "sse4_1", "sse4_2"},
    "x86-64-v3": {"avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"},
    "x86-64-v4": {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
}


def _processor() -> set[str] | None:
    """The flags of the processor; None where they are not known."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return None
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            return next((set(line.split()) for line in file if line.startswith("flags")), None)
    except OSError:
        return None


def _missing(level: str, flags: set[str] | None) -> set[str]:
    """What the processor lacks for a level; a level that is not in the table (native) lacks nothing."""
    if flags is None or level not in _FLAGS:
        return set()
    return set().union(*(_FLAGS[each] for each in _FLAGS if each <= level)) - flags


def load_core() -> None:
    """Makes `nacre._core` the module of the highest level that runs here, or of the level that NACRE_LEVEL names.

    Raises ImportError where there is none.
    """
    flags, wanted = _processor(), os.environ.get("NACRE_LEVEL")
    here = os.path.dirname(__file__)
    found = {_build.march: here} | {level: os.path.join(here, "levels", level) for level in _build.levels}
    if wanted and wanted not in found:
        raise ImportError(f"NACRE_LEVEL={wanted}: this build of nacre has {', '.join(sorted(found))}")
    candidates = [wanted] if wanted else sorted(found, reverse=True)
    for level in candidates:
        if not _missing(level, flags):
            break
    else:
        level = candidates[-1]
        lacks = ", ".join(sorted(_missing(level, flags)))
        raise ImportError(f"nacre needs a processor of the level {level}; this one has no {lacks}")
    if "nacre._core" in sys.modules:  # `nacre` is loaded again
        return
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        path = os.path.join(found[level], "_core" + suffix)
        if os.path.exists(path):
            spec = importlib.util.spec_from_file_location("nacre._core", path)
            assert spec and spec.loader
            module = importlib.util.module_from_spec(spec)
            sys.modules["nacre._core"] = module
            try:
                spec.loader.exec_module(module)
            except BaseException:
                del sys.modules["nacre._core"]
                raise
            setattr(sys.modules["nacre"], "_core", module)
            return
    raise ImportError(f"nacre is not installed completely: there is no _core in {found[level]}")
