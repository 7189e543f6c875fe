# Nacre: nacre.view: the window of the program, drawn without a display where the test runs.
import json
import os
import stat
import subprocess
import time

import numpy as np
import pytest
from conftest import bean, torus

import nacre


@pytest.fixture(scope="module")
def offscreen(tmp_path_factory):
    """A stand-in for the program that draws into a picture and keeps the words and files that it got."""
    program = os.environ.get("NACRE_PROGRAM", "")
    if not program:
        pytest.skip("NACRE_PROGRAM is not set: there is no window")
    words = ["view", "--offscreen", "--sample", "sphere", "--detail", "24", "--resolution", "32", "--frames-count", "1"]
    if subprocess.run([program, *words, "--quiet"], capture_output=True).returncode != 0:
        pytest.skip("the viewer does not run here")
    folder = tmp_path_factory.mktemp("view")
    script = folder / "nacre"
    script.write_text(
        f"""#!/bin/bash
if [[ $1 == --version ]]; then exec {program} --version; fi
printf '%s\\n' "$@" >{folder}/words
exec {program} "$@" --offscreen --frames-count 3 --image {folder}/picture.png --report {folder}/report.json --quiet
"""
    )
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return script, folder


def picture(folder):
    imageio = pytest.importorskip("imageio.v3")
    return imageio.imread(folder / "picture.png")[..., :3].astype(float)


def test_a_volume(offscreen):
    script, folder = offscreen
    window = nacre.view(
        bean(), spacing=(0.7, 0.8, 1.25), names={3: "liver"}, max_size=2.5, labels=True, width=320, height=240,
        program=script, block=True,
    )
    assert not window.running and repr(window) == "<nacre.View: closed>"
    words = (folder / "words").read_text().split("\n")
    assert "max_size=2.5" in words and "labels=true" in words
    assert not os.path.exists(words[1]), "temporary files stay"
    assert picture(folder).shape == (240, 320, 3) and picture(folder).std() > 10
    report = json.loads((folder / "report.json").read_text())
    assert "mesh" in json.dumps(report)


def test_a_flow_in_time(offscreen):
    script, folder = offscreen
    points, triangles, velocity = torus(32, 16)
    nacre.view(
        points, triangles, lambda t: velocity * (1 + t), times=[0, 1, 2], scalars={"height": points[:, 2]},
        resolution=64, color="height", width=320, height=240, program=script, block=True,
    )
    assert "vectors=velocity" in (folder / "words").read_text().split("\n")
    assert picture(folder).std() > 10


def test_a_file(offscreen, tmp_path):
    script, folder = offscreen
    with pytest.raises(nacre.Error, match="could not be shown"):
        nacre.view(tmp_path / "missing.vtp", program=script, block=True)


def test_it_can_be_closed(tmp_path):
    script = tmp_path / "nacre"
    script.write_text("#!/bin/bash\nif [[ $1 == --version ]]; then echo 'nacre 0.1.0'; exit; fi\nexec sleep 60\n")
    script.chmod(0o755)
    window = nacre.view(bean(), program=script)
    assert window.running and not window.wait(0.1)
    begin = time.monotonic()
    window.close()
    assert not window.running and time.monotonic() - begin < 20


def test_a_program_of_others_is_not_started(tmp_path):
    other = tmp_path / "nacre"
    other.write_text("#!/bin/bash\necho something else\n")
    other.chmod(0o755)
    with pytest.raises(nacre.Error, match="another program"):
        nacre.view(bean(), program=other)
    with pytest.raises(nacre.Error, match="cannot be run"):
        nacre.view(bean(), program=tmp_path / "missing")
    with pytest.raises(nacre.Error, match="no knob"):
        nacre.view(bean(), maxsize=2)


def test_no_program(monkeypatch):
    monkeypatch.delenv("NACRE_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(nacre.Error, match="not on the path"):
        nacre.view(np.zeros((4, 4, 4), np.uint8))
