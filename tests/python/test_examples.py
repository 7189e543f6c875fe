# Nacre: the examples of python/examples, run as a user runs them.
import re
import subprocess
import sys

import pytest


def run(folder, name, *arguments):
    done = subprocess.run(
        [sys.executable, str(folder / "python/examples" / name), *map(str, arguments)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_heat(folder):
    pytest.importorskip("skfem")
    said = run(folder, "heat.py")
    assert float(re.search(r"largest error ([0-9.]+)%", said)[1]) < 3


def test_flow_video(folder, tmp_path):
    imageio = pytest.importorskip("imageio.v3")
    pytest.importorskip("imageio_ffmpeg")
    said = run(folder, "flow_video.py", tmp_path / "flow.mp4")
    assert said.startswith("24 frames") and float(re.search(r"([0-9.]+) grey", said)[1]) > 2
    film = imageio.imread(tmp_path / "flow.mp4")
    assert film.shape == (24, 304, 400, 3)
