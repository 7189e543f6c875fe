"""The compiled module is chosen for the processor."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from nacre import _build, _levels

LEVEL_2 = {"cx16", "popcnt", "ssse3", "sse4_1", "sse4_2"}
LEVEL_3 = LEVEL_2 | {"avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"}


def start(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, **environment}
    )


def test_levels_contain_those_below() -> None:
    assert not _levels._missing("x86-64-v2", LEVEL_2)
    assert _levels._missing("x86-64-v3", LEVEL_2) == LEVEL_3 - LEVEL_2
    assert not _levels._missing("x86-64-v3", LEVEL_3)
    assert _levels._missing("x86-64-v3", LEVEL_3 - LEVEL_2) == LEVEL_2
    assert "avx512f" in _levels._missing("x86-64-v4", LEVEL_3)


def test_other_builds_and_unknown_processors_are_trusted() -> None:
    assert not _levels._missing("native", set())
    assert not _levels._missing("x86-64-v4", None)


def test_the_level_that_is_asked_for_is_taken() -> None:
    run = start("import nacre; print(nacre._core.__file__)", NACRE_LEVEL=_build.march)
    assert run.returncode == 0, run.stderr
    assert os.path.basename(run.stdout.strip()).startswith("_core")


def test_a_level_that_is_not_there_is_named() -> None:
    run = start("import nacre", NACRE_LEVEL="x86-64-v9")
    assert run.returncode == 1
    assert "ImportError: NACRE_LEVEL=x86-64-v9: this build of nacre has " + _build.march in run.stderr


def test_an_old_processor_is_told_what_it_lacks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NACRE_LEVEL", raising=False)
    monkeypatch.setattr(_build, "march", "x86-64-v3")
    monkeypatch.setattr(_build, "levels", ())
    monkeypatch.setattr(_levels, "_processor", lambda: LEVEL_3 - {"fma"})
    with pytest.raises(ImportError, match="the level x86-64-v3; this one has no fma"):
        _levels.load_core()
