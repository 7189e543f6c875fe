# Nacre: what results say of how they were made.
import hashlib
import json
import pickle

import numpy as np
import pytest
from conftest import bean, torus

import nacre


def origin_of(path):
    content = path.read_bytes().decode("latin-1")
    return json.JSONDecoder().raw_decode(content, content.index('{"Nacre origin":'))[0]


def sha256(values):
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


def arrays_of(origin):
    return {each["file"]: each["sha256"] for each in origin["arrays"]}


@pytest.mark.parametrize("extension", ["vtp", "ply", "vtu", "msh"])
def test_meshes_name_version_knobs_and_voxels(tmp_path, extension):
    mesh = nacre.mesh(bean(), max_size=1.5, seed=3)
    mesh.save(tmp_path / f"a.{extension}")
    origin = origin_of(tmp_path / f"a.{extension}")
    assert (origin["version"], origin["command"]) == (nacre.__version__, "mesh")
    assert origin["knobs"] == {"max_size": "1.5", "seed": "3"}
    assert arrays_of(origin) == {"volume": sha256(bean())}


def test_a_pickled_mesh_keeps_what_it_says(tmp_path):
    mesh = nacre.mesh(bean())
    mesh.save(tmp_path / "a.ply")
    pickle.loads(pickle.dumps(mesh)).save(tmp_path / "b.ply")
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_frames_name_knobs_and_the_arrays_read_so_far(tmp_path):
    points, triangles, velocity = torus()
    steps = np.stack([velocity, velocity[:, [1, 0, 2]]])
    flow = nacre.flow(points, triangles, steps, steps=3, resolution=64, width=96, height=72)
    for frame in flow:
        frame.save(tmp_path / "a.png")
    frame.save(tmp_path / "a.vtp")
    for name in ("a.png", "a.vtp"):
        origin = origin_of(tmp_path / name)
        assert origin["options"] == ["frame=3"]
        assert origin["knobs"]["resolution"] == "64"
        arrays = arrays_of(origin)
        assert arrays["points"] == sha256(points.astype(np.float64))
        assert arrays["triangles"] == sha256(triangles.astype(np.uint32))
        each = "".join(sha256(step.astype(np.float32)) for step in steps)
        assert arrays["vectors"] == hashlib.sha256(each.encode()).hexdigest()


def test_the_program_says_why_it_cannot_make_them_again(program, tmp_path):
    nacre.mesh(bean()).save(tmp_path / "a.vtp")
    with pytest.raises(AssertionError, match="arrays in memory"):
        program("rerun", tmp_path / "a.vtp")
