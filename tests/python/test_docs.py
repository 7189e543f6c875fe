# Nacre: the code of docs/python.md runs as it stands, one block after the other.
import re

import numpy as np
from conftest import torus


def test_code_of_the_page(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (folder / "docs/python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 3
    points, triangles, velocity = torus()
    times = np.linspace(0, 1, 3)
    names = {"points": points, "triangles": triangles, "times": times, "velocity": lambda t: velocity * (1 + t)}
    for block in blocks:
        small = block.replace("resolution=512, steps=40", "resolution=48, steps=3, width=160, height=120")
        small = small.replace("(800, 600)", "(80, 60)").replace("frame.index == 20", "frame.index == 1")
        exec(compile(small, "docs/python.md", "exec"), names)
    assert (tmp_path / "liver.vtu").stat().st_size > 10000 and (tmp_path / "frame.png").exists()
    assert len(names["fine"].points) > 1.5 * len(names["coarse"].points)
