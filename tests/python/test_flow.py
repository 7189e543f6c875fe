# Nacre: flow from Python.
import json

import numpy as np
import pytest
from conftest import result_bytes, torus, write_vtp

import nacre

SMALL = dict(resolution=128, width=320, height=240)


def test_frames_equal_those_of_the_program(program, tmp_path):
    points, triangles, velocity = torus()
    later = velocity[:, [1, 0, 2]]
    write_vtp(tmp_path / "a.vtp", points, triangles, velocity)
    write_vtp(tmp_path / "b.vtp", points, triangles, later)
    inputs = [tmp_path / "a.vtp", tmp_path / "b.vtp"]
    words = ["--resolution", "128", "--size", "320x240", "--steps", "4", "--orbit", "5"]
    program("flow", *inputs, *words, "--frames", tmp_path / "frames", "--out", tmp_path / "theirs.vtp", "--report",
            tmp_path / "report.json")
    flow = nacre.flow(points, triangles, np.stack([velocity, later]), steps=4, orbit=5, name="a.vtp", **SMALL)
    assert len(flow) == 4
    for frame in flow:
        frame.save(tmp_path / "ours.png")
        theirs = (tmp_path / "frames" / f"frame_{frame.index:04d}.png").read_bytes()
        assert result_bytes(tmp_path / "ours.png") == theirs, frame
    frame.save(tmp_path / "ours.vtp")
    assert result_bytes(tmp_path / "ours.vtp") == result_bytes(tmp_path / "theirs.vtp")
    theirs = json.loads((tmp_path / "report.json").read_text())
    ours = flow.report
    for part in ("nacre", "command", "input", "parameters", "embedding"):
        if part != "parameters":
            assert ours[part] == theirs[part], part
    differs = {k for k in theirs["parameters"] if ours["parameters"][k] != theirs["parameters"][k]}
    assert differs <= {"vectors"}


def test_an_analytic_field_equals_that_of_the_program(program, tmp_path):
    points, triangles, velocity = torus()
    write_vtp(tmp_path / "a.vtp", points, triangles, velocity)
    program("flow", tmp_path / "a.vtp", "--vectors", "@swirl", "--resolution", "96", "--size", "160x120", "--steps", "3",
            "--image", tmp_path / "theirs.png")
    for frame in nacre.flow(points, triangles, "@swirl", resolution=96, width=160, height=120, steps=3):
        pass
    frame.save(tmp_path / "ours.png")
    assert result_bytes(tmp_path / "ours.png") == result_bytes(tmp_path / "theirs.png")


def test_a_surface_that_moves_equals_that_of_the_program(program, tmp_path):
    points, triangles, velocity = torus()
    times = [0.0, 1.0, 2.0]

    def turned(time):
        c, s = np.cos(0.4 * time), np.sin(0.4 * time)
        return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) * (1 + 0.1 * time)

    for k, time in enumerate(times):
        write_vtp(tmp_path / f"m_{k}.vtp", turned(time), triangles, velocity)
    program("flow", *(tmp_path / f"m_{k}.vtp" for k in range(3)), "--resolution", "128", "--size", "320x240", "--steps",
            "4", "--image", tmp_path / "theirs.png", "--out", tmp_path / "theirs.vtp")
    stacked = np.stack([turned(t) for t in times])
    for moving, when in ((stacked, None), (turned, times)):
        flow = nacre.flow(moving, triangles, velocity, times=when, steps=4, name="m_0.vtp", **SMALL)
        for frame in flow:
            pass
        frame.save(tmp_path / "ours.png")
        frame.save(tmp_path / "ours.vtp")
        assert result_bytes(tmp_path / "ours.png") == result_bytes(tmp_path / "theirs.png")
        assert result_bytes(tmp_path / "ours.vtp") == result_bytes(tmp_path / "theirs.vtp")
        assert flow.report["motion"]["groups"] == 1
    with pytest.raises(nacre.Error, match="need times"):
        nacre.flow(turned, triangles, velocity)
    with pytest.raises(nacre.Error, match="same points"):
        nacre.flow(lambda t: points[: len(points) - int(t)], triangles, velocity, times=times, steps=2, **SMALL)
    with pytest.raises(nacre.Error, match="3 steps"):
        nacre.flow(stacked, triangles, velocity, times=[0, 1])


def test_a_function_of_time_is_the_same_as_its_arrays():
    points, triangles, velocity = torus()
    times = [0.0, 0.5, 2.0]
    arrays = nacre.flow(points, triangles, np.stack([velocity * (1 + t) for t in times]), times=times, steps=3, **SMALL)
    calls = []

    def field(time):
        calls.append(time)
        return velocity * (1 + time)

    function = nacre.flow(points, triangles, field, times=times, steps=3, **SMALL)
    for a, b in zip(arrays, function):
        assert a.time == b.time
        assert np.array_equal(a.image, b.image)
    assert set(calls) == set(times)


def test_knobs_are_live():
    points, triangles, velocity = torus()
    flow = nacre.flow(points, triangles, velocity, times=[0.0], steps=6, **SMALL)
    first = next(flow)
    image = first.image
    flow.colormap = "ember"
    assert not np.array_equal(first.image, image)
    flow.ttl = 8
    second = next(flow)
    assert flow.ttl == 8 and second.index == 1
    with pytest.raises(nacre.Error, match="frame 0 is gone"):
        first.values
    flow.resolution = 64
    assert len(next(flow).values.value) < 15000
    with pytest.raises(nacre.Error, match="cannot be changed"):
        flow.steps = 9
    with pytest.raises(nacre.Error, match="out of range"):
        flow.ttl = 99
    assert flow.ttl == 8
    assert [frame.index for frame in flow] == [3, 4, 5]


def test_values_and_pictures():
    points, triangles, velocity = torus()
    frame = next(nacre.flow(points, triangles, velocity, **SMALL))
    cells = frame.values
    n = len(cells.value)
    assert cells.centre.shape == cells.closest_point.shape == cells.velocity.shape == cells.normal.shape == (n, 3)
    assert 0 <= cells.value.min() and cells.value.max() <= 1 and cells.value.std() > 0.05
    assert np.abs(np.einsum("ij,ij->i", cells.velocity, cells.normal)).max() < 1e-3
    near = nacre.closest_points(points, triangles, cells.closest_point)
    assert near.distance.max() < 1e-8
    assert frame.sample(cells.closest_point[:50]).shape == (50,)
    assert frame.image.shape == (240, 320, 4)
    camera = {"eye": (0, 0, 9), "target": (0, 0, 0), "up": (0, 1, 0), "height": 6}
    top = frame.render(camera=camera, size=(64, 48))
    assert top.shape == (48, 64, 4)
    assert not np.array_equal(top, frame.render(camera="+x", size=(64, 48)))


def test_colour_by_scalars():
    points, triangles, velocity = torus()
    plain = next(nacre.flow(points, triangles, velocity, legend=False, **SMALL)).image
    heat = {"heat": points[:, 2]}
    coloured = next(nacre.flow(points, triangles, velocity, scalars=heat, color="heat", legend=False, **SMALL)).image
    assert not np.array_equal(plain, coloured)
    with pytest.raises(nacre.Error, match="no array 'cold'"):
        nacre.flow(points, triangles, velocity, scalars=heat, color="cold", **SMALL)


def test_closest_points_against_all_triangles():
    points, triangles, _ = torus(16, 8)
    queries = np.random.default_rng(1).normal(size=(200, 3)) * 2
    found = nacre.closest_points(points, triangles, queries)
    assert np.allclose(np.linalg.norm(found.points - queries, axis=1), found.distance)
    # No triangle has a point nearer than that: a dense sample of all triangles.
    grid = np.array([(a, b) for a in np.linspace(0, 1, 9) for b in np.linspace(0, 1, 9) if a + b <= 1])
    a, b, c = (points[triangles[:, k]] for k in range(3))
    dense = (a[:, None] + grid[None, :, :1] * (b - a)[:, None] + grid[None, :, 1:] * (c - a)[:, None]).reshape(-1, 3)
    brute = np.array([np.linalg.norm(dense - q, axis=1).min() for q in queries])
    assert np.all(found.distance <= brute + 1e-12)
    assert np.all(found.distance >= brute - 0.15)
    corner = points[triangles[found.triangles]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    off = np.einsum("ij,ij->i", normal, found.points - corner[:, 0]) / np.linalg.norm(normal, axis=1)
    assert np.abs(off).max() < 1e-12
    assert nacre.closest_points(points, triangles, np.zeros((0, 3))).points.shape == (0, 3)
