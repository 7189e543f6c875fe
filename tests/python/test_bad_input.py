# Nacre: bad input from Python is an exception with advice, and the interpreter lives.
import numpy as np
import pytest
from conftest import torus, two_balls

import nacre


def labels_with(value):
    labels = two_balls(12).astype(np.float64)
    labels[3, 3, 3] = value
    return labels


@pytest.mark.parametrize(
    "volume, words",
    [
        (np.zeros((4, 4)), "shape"),
        (np.zeros((4, 4, 4, 2)), "shape"),
        (np.zeros((0, 4, 4)), "empty"),
        (np.zeros((1, 8, 8), np.uint8), "at least 2"),
        (np.zeros((8, 8, 8), np.uint8), "one material only"),
        (np.ones((8, 8, 8), np.uint8), "every voxel is 1"),
        (np.full((8, 8, 8), np.nan), ""),
        (np.zeros((8, 8, 8), complex), "complex"),
        (np.full((8, 8, 8), "a"), "not numbers"),
        (np.zeros((8, 8, 8), object), "object"),
        (None, "object"),
        ("labels.nrrd", "numbers"),
        ([np.zeros((4, 4, 4)), np.zeros((5, 4, 4))], ""),
        ([[1, 2], [3]], ""),
        ([], "shape"),
        (np.random.default_rng(0).normal(size=(8, 8, 8)), "isovalue"),
    ],
)
def test_volumes(volume, words):
    with pytest.raises(nacre.Error) as caught:
        nacre.mesh(volume)
    assert words in str(caught.value)
    assert "--" not in str(caught.value)
    assert caught.value.what


@pytest.mark.parametrize(
    "arguments, words",
    [
        ({"spacing": (1, 1)}, "three"),
        ({"spacing": (1, 0, 1)}, "above 0"),
        ({"spacing": (1, -1, 1)}, "above 0"),
        ({"spacing": (1, np.nan, 1)}, "finite"),
        ({"spacing": "wide"}, "three numbers"),
        ({"origin": (np.inf, 0, 0)}, "finite"),
        ({"direction": np.ones((3, 3))}, "orthogonal"),
        ({"direction": np.eye(2)}, "(3, 3)"),
        ({"order": "yxz"}, "order"),
        ({"device": "tpu"}, "no device"),
        ({"device": "cuda:77"}, ""),
        ({"threads": -1}, "threads"),
        ({"preset": "best"}, "no preset"),
        ({"max_size": "big"}, "number"),
        ({"max_size": np.nan}, "range"),
        ({"max_size": -1}, "0.05..1000"),
        ({"max_size": True}, "number"),
        ({"iterations": 2.5}, "whole"),
        ({"iterations": 2**80}, "range"),
        ({"min_size": 3, "max_size": 2}, "larger than max_size"),
        ({"solver": "best"}, "tree|redblack|serial"),
        ({"maxsize": 1}, "did you mean max_size"),
        ({"isovalue": 1, "labels": True}, ""),
        ({"materials": [77]}, "77"),
        ({"isovalue": object()}, "isovalue"),
        ({"progress": 3}, "function"),
    ],
)
def test_arguments(arguments, words):
    with pytest.raises(nacre.Error) as caught:
        nacre.mesh(two_balls(12), **arguments)
    assert words in str(caught.value)
    assert "--" not in str(caught.value)


def test_an_error_has_three_parts():
    with pytest.raises(nacre.Error) as caught:
        nacre.mesh(np.random.default_rng(0).normal(size=(8, 8, 8)))
    error = caught.value
    assert error.what == "volume needs an iso-value" and "not labels" in error.why and "isovalue" in error.advice
    assert str(error) == f"{error.what} ({error.why}); {error.advice}"


def test_labels_that_are_no_numbers_become_outside():
    with pytest.warns(nacre.Warning, match="not numbers became outside"):
        mesh = nacre.mesh(labels_with(np.nan))
    assert mesh.labels == [2, 5]


def test_negative_and_large_labels():
    labels = two_balls(12).astype(np.int64)
    labels[labels == 2] = -7
    labels[labels == 5] = 2**40
    mesh = nacre.mesh(labels)
    assert mesh.labels == [-7, 2**40] and set(map(tuple, mesh.materials)) == {(0, -7), (-7, 2**40)}


P, T, V = torus(12, 8)
WRONG = P.copy()
WRONG[0] = np.nan


@pytest.mark.parametrize(
    "points, triangles, velocity, more, words",
    [
        (P[:, :2], T, V, {}, "(n, 3)"),
        (P, T[:, :2], V, {}, "(n, 3)"),
        (P, T, V[:-1], {}, "one row per point"),
        (P, T, np.stack([V, V]), {"times": [0]}, "1 times and 2 steps"),
        (P, T, np.stack([V, V]), {"times": [1, 0]}, "ascend"),
        (P, T, np.stack([V, V]), {"times": [0, np.nan]}, "finite"),
        (P, T, lambda t: V, {}, "needs times"),
        (P, T, lambda t: V[:3], {"times": [0, 1]}, "one row per point"),
        (P, T + 1000000, V, {}, ""),
        (P, -T - 1, V, {}, ""),
        (P, T + 0.5, V, {}, "whole"),
        (P, T[:0], V, {}, "no triangles"),
        (P[:0], T, V[:0], {}, "no points"),
        (P, T, "@vortex", {}, "analytic"),
        (P, T, None, {}, "velocity"),
        (P, T, V, {"color": "heat"}, "heat"),
        (P, T, V, {"colormap": "rainbow"}, "rainbow"),
        (P, T, V, {"camera": "behind"}, "behind"),
        (P, T, V, {"background": "red"}, "background"),
        (P, T, V, {"color_range": (3, 1)}, "color_range"),
        (P, T, V, {"scalars": {"heat": np.zeros(3)}}, "heat"),
        (P, T, V, {"resolution": 2}, "16.."),
        (P, T, V, {"vectors": "a"}, "no knob"),
    ],
)
def test_flows(points, triangles, velocity, more, words):
    with pytest.raises(nacre.Error) as caught:
        next(nacre.flow(points, triangles, velocity, **{"resolution": 64, **more}))
    assert words in str(caught.value)
    assert "--" not in str(caught.value)


def test_points_that_are_not_finite_are_dropped_with_their_triangles():
    with pytest.warns(nacre.Warning, match="not finite"):
        next(nacre.flow(WRONG, T, V, resolution=64))


def test_velocities_that_are_not_finite_do_not_spread():
    wrong = V.copy()
    wrong[3] = np.nan
    image = next(nacre.flow(P, T, wrong, resolution=64, width=64, height=64)).image
    assert image[..., :3].std() > 1


def test_cameras():
    frame = next(nacre.flow(P, T, V, resolution=64))
    for camera in ("behind", {"eye": (0, 0, 0)}, {"eye": (0, 0, 0), "target": (0, 0, 0), "height": 1}, 3):
        with pytest.raises(nacre.Error):
            frame.render(camera=camera)
    with pytest.raises(nacre.Error):
        frame.render(size=(0, 10))


def test_files(tmp_path, ball_mesh):
    for name in ("a.xyz", "a", "folder-that-is-not/a.vtp", "folder-that-is-not/a.vtu"):
        with pytest.raises(nacre.Error):
            ball_mesh.save(tmp_path / name)
    with pytest.raises(nacre.Error):
        next(nacre.flow(P, T, V, resolution=64)).save(tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("query", [[[0, 0, np.nan]], [[0, 0]], "a"])
def test_queries(query):
    with pytest.raises(nacre.Error):
        nacre.closest_points(P, T, query)


def test_surfaces_of_closest_points():
    for triangles in (T + 1000, -T - 1, T[:0]):
        with pytest.raises(nacre.Error):
            nacre.closest_points(P, triangles, P)
    with pytest.raises(nacre.Error, match="not finite"):
        nacre.closest_points(WRONG, T, P)
