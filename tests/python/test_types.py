# Nacre: the stubs, the list of knobs, and what help() says.
import inspect
import pathlib
import subprocess
import sys

import pytest

import nacre

USE = '''
import numpy as np
import nacre

mesh = nacre.mesh(np.zeros((4, 4, 4), np.uint8), max_size=1.5, solver="tree", materials=[1, 2], merge={3: 1})
points: np.ndarray = mesh.points
ratio: float = mesh.quality.radius_ratio_mean
for stage in nacre.meshing(np.zeros((4, 4, 4))):
    name: str = stage.name
for frame in nacre.flow(points, mesh.triangles, points, ttl=8):
    value: np.ndarray = frame.values.value
nacre.save_tetrahedra("a.msh", points, mesh.tetrahedra().cells, names={1: "liver"})
window: nacre.View = nacre.view(np.zeros((4, 4, 4)), max_size=1.5)
closed: bool = window.wait(1.0)
'''
WRONG = '''
import nacre
nacre.mesh(0, maxsize=1)
nacre.mesh(0, solver="best")
nacre.mesh(0).quality.ratio
nacre.flow(0, ttl="8")
'''


def mypy(*arguments):
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", *arguments], capture_output=True, text=True)
    return done.returncode, done.stdout


def test_types_pass_mypy(tmp_path):
    status, said = mypy("-p", "nacre")
    assert status == 0, said
    (tmp_path / "use.py").write_text(USE)
    status, said = mypy(str(tmp_path / "use.py"))
    assert status == 0, said
    (tmp_path / "wrong.py").write_text(WRONG)
    status, said = mypy(str(tmp_path / "wrong.py"))
    assert status == 1 and said.count("error:") == 4, said


def test_the_list_of_knobs_is_that_of_the_library(folder):
    made = subprocess.run(
        [sys.executable, str(folder / "python/tools/make_knobs.py")], capture_output=True, text=True, check=True
    )
    assert made.stdout == (folder / "python/nacre/_knobs.py").read_text(), (
        "run: python python/tools/make_knobs.py > python/nacre/_knobs.py"
    )


@pytest.mark.parametrize("job", ["mesh", "flow"])
def test_help_lists_all_knobs(job):
    function = getattr(nacre, job)
    names = inspect.signature(function).parameters
    for knob in nacre.knobs(job):
        assert knob.name in names and names[knob.name].default == knob.default
        assert knob.help in function.__doc__
        assert knob.help and "--" not in knob.help
    assert len(nacre.knobs(job)) > 25


def test_public_names_have_docstrings():
    for name in nacre.__all__:
        if name != "Progress" and not isinstance(getattr(nacre, name), list):
            assert inspect.getdoc(getattr(nacre, name)), name


def test_version(folder):
    header = pathlib.Path(folder / "include/nacre/version.hpp").read_text()
    assert f'"{nacre.__version__}"' in header
    assert nacre.devices()[0].request == "cpu"
