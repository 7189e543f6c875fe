# Nacre: the notebooks of python/examples, run as a user runs them.
import base64
import re

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")


def run(folder, name, position):
    """Everything that the cells of a notebook gave: text, and data by kind."""
    notebook = nbformat.read(folder / "python/examples" / name, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "notebooks are kept without their outputs"
    nbclient.NotebookClient(notebook, timeout=900, resources={"metadata": {"path": str(position)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output["text"] for output in outputs if output.output_type == "stream")
    return text, [output["data"] for output in outputs if "data" in output]


def test_heat(folder, tmp_path):
    pytest.importorskip("skfem")
    imageio = pytest.importorskip("imageio.v3")
    said, data = run(folder, "heat.ipynb", tmp_path)
    assert float(re.search(r"largest error ([0-9.]+)%", said)[1]) < 3
    pictures = [each["image/png"] for each in data if "image/png" in each]
    assert len(pictures) == 1
    picture = imageio.imread(base64.b64decode(pictures[0]))
    assert picture.shape[:2] == (480, 640) and picture[..., :3].std() > 20
    assert "ELSET=FAT" in (tmp_path / "tissues.inp").read_text().upper()


def test_flow_video(folder, tmp_path):
    imageio = pytest.importorskip("imageio.v3")
    pytest.importorskip("imageio_ffmpeg")
    said, data = run(folder, "flow_video.ipynb", tmp_path)
    assert said.startswith("24 frames") and float(re.search(r"([0-9.]+) grey", said)[1]) > 2
    shown = [each["text/html"] for each in data if "<video" in each.get("text/html", "")]
    assert len(shown) == 1
    inline = base64.b64decode(re.search(r"base64,([A-Za-z0-9+/=]+)", shown[0])[1])
    assert inline == (tmp_path / "flow.mp4").read_bytes()
    assert imageio.imread(inline, extension=".mp4").shape == (24, 304, 400, 3)
