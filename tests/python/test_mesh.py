# Nacre: meshes from Python.
import copy
import json

import numpy as np
import pytest
from conftest import assert_equal, bean, result_bytes, two_balls, write_nrrd

import nacre

SPACING, ORIGIN = (0.7, 0.8, 1.25), (1.0, 2.0, -3.0)


@pytest.mark.parametrize("extension", ["vtp", "ply", "obj", "stl", "off", "vtu", "msh"])
def test_files_equal_those_of_the_program(program, tmp_path, extension):
    write_nrrd(tmp_path / "bean.nrrd", bean(), SPACING, ORIGIN)
    program("mesh", tmp_path / "bean.nrrd", "--max-size", "1.5", "--out", tmp_path / f"theirs.{extension}")
    mesh = nacre.mesh(bean(), spacing=SPACING, origin=ORIGIN, max_size=1.5)
    mesh.save(tmp_path / f"ours.{extension}")
    assert result_bytes(tmp_path / f"ours.{extension}") == result_bytes(tmp_path / f"theirs.{extension}")


def test_report_is_that_of_the_program(program, tmp_path):
    write_nrrd(tmp_path / "bean.nrrd", bean(), SPACING, ORIGIN)
    program("mesh", tmp_path / "bean.nrrd", "--report", tmp_path / "report.json", "--out", tmp_path / "mesh.vtu")
    theirs = json.loads((tmp_path / "report.json").read_text())
    mesh = nacre.mesh(bean(), spacing=SPACING, origin=ORIGIN, name="bean.nrrd")
    mesh.tetrahedra()
    ours = mesh.report
    for part in ("nacre", "command", "input", "parameters", "embedding", "fields", "mesh", "tetrahedra"):
        assert_equal(ours[part], theirs[part], part)


@pytest.mark.parametrize(
    "theirs, ours",
    [
        (["--isovalue", "0.5,1.5"], {"isovalue": [0.5, 1.5]}),
        (["--threshold", "0.5:9"], {"threshold": (0.5, 9)}),
        (["--preset", "source", "--isovalue", "1"], {"preset": "source", "isovalue": 1}),
    ],
)
def test_scalars_and_presets(program, tmp_path, theirs, ours):
    z, y, x = np.mgrid[:20, :20, :20].astype(np.float32)
    field = 3 - 0.35 * np.sqrt((x - 9.4) ** 2 + (y - 9.6) ** 2 + (z - 9.5) ** 2)
    write_nrrd(tmp_path / "field.nrrd", field.astype(np.float32))
    program("mesh", tmp_path / "field.nrrd", *theirs, "--out", tmp_path / "theirs.vtp")
    nacre.mesh(field.astype(np.float32), **ours).save(tmp_path / "ours.vtp")
    assert result_bytes(tmp_path / "ours.vtp") == result_bytes(tmp_path / "theirs.vtp")


def test_materials_can_be_chosen_and_merged(program, tmp_path):
    write_nrrd(tmp_path / "bean.nrrd", bean())
    program("mesh", tmp_path / "bean.nrrd", "--merge", "9:3", "--materials", "3", "--out", tmp_path / "theirs.vtp")
    mesh = nacre.mesh(bean(), merge={9: 3}, materials=[3])
    assert mesh.labels == [3]
    mesh.save(tmp_path / "ours.vtp")
    assert result_bytes(tmp_path / "ours.vtp") == result_bytes(tmp_path / "theirs.vtp")


def test_arrays(ball_mesh):
    m = ball_mesh
    assert m.points.dtype == np.float64 and m.points.shape[1] == 3
    assert m.triangles.dtype == np.int64 and m.triangles.max() == len(m.points) - 1
    assert set(map(tuple, m.materials)) == {(0, 2), (2, 5)}
    assert m.labels == [2, 5] and m.outside == 0 and m.names == {0: "outside", 2: "shell", 5: "core"}
    assert m.quality.sound and m.quality.flaws == [] and m.quality.radius_ratio_mean > 0.95
    points, triangles = m.surface(5)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi * (0.2 * 24 * 0.5) ** 3, rel=0.06)


def test_tetrahedra_fill_the_materials(ball_mesh):
    t = ball_mesh.tetrahedra()
    a, b, c, d = (t.points[t.cells[:, k]] for k in range(4))
    volume = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6
    assert volume.min() > 0
    for entry in ball_mesh.report["mesh"]["materials"]:
        assert volume[t.labels == entry["label"]].sum() == pytest.approx(entry["volume"], rel=1e-9)
    finer = ball_mesh.tetrahedra(max_cell=1)
    assert len(finer.cells) > 1.3 * len(t.cells)
    assert len(ball_mesh.tetrahedra(max_cell=0).cells) == len(t.cells)


def test_a_mesh_of_stars_is_triangulated_anew_before_it_is_filled():
    mesh = nacre.mesh(two_balls(20), max_size=2)
    assert mesh.report["mesh"]["stars"]["meshes"] > 0
    stars = mesh.triangles
    t = mesh.tetrahedra()
    assert "stars" not in mesh.report["mesh"]
    assert mesh.triangles is not stars
    assert np.array_equal(t.points[: len(mesh.points)], mesh.points)
    facets = np.sort(t.cells[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3), axis=1)
    assert {tuple(f) for f in np.sort(mesh.triangles, axis=1)} <= {tuple(f) for f in facets}
    again = mesh.triangles
    mesh.tetrahedra()
    assert mesh.triangles is again
    with pytest.raises(nacre.Error, match="triangulation"):
        nacre.mesh(two_balls(20), max_size=2, triangulation="stars").tetrahedra()


def test_second_order(program, tmp_path):
    write_nrrd(tmp_path / "a.nrrd", two_balls(20))
    options = ("mesh", tmp_path / "a.nrrd", "--labels", "--max-size", "2", "--element-order", "2")
    mesh = nacre.mesh(two_balls(20), labels=True, max_size=2, element_order=2)
    surface = copy.copy(mesh)  # before it is triangulated anew
    for file, surface_only in (("a.vtu", False), ("a.msh", False), ("b.msh4", True)):
        program(*options, "--out", tmp_path / file, *(["--surface-only"] if surface_only else []))
        (surface if surface_only else mesh).save(tmp_path / f"ours_{file}", surface_only)
        assert result_bytes(tmp_path / f"ours_{file}") == result_bytes(tmp_path / file)
    t = mesh.tetrahedra()
    assert t.order == 2 and t.cells.shape[1] == 10 and t.cells.max() == len(t.points) - 1
    a, b = t.points[t.cells[:, 0]], t.points[t.cells[:, 1]]
    off = np.linalg.norm(t.points[t.cells[:, 4]] - (a + b) / 2, axis=1)
    assert (off < 0.31 * np.linalg.norm(b - a, axis=1)).all() and off.max() > 0
    assert mesh.midsides.shape == mesh.triangles.shape and mesh.midsides.min() > mesh.triangles.max()
    report = mesh.report["second_order"]
    assert report["nodes"] == len(t.points) - t.cells[:, :4].max() - 1
    assert report["deviation_voxels"]["order_2"]["mean"] < report["deviation_voxels"]["order_1"]["mean"]
    straight = mesh.tetrahedra(order=1)
    assert straight.order == 1 and np.array_equal(straight.cells, t.cells[:, :4])
    straight.save(tmp_path / "straight.msh")  # of a mesh that has midsides
    with pytest.raises(nacre.Error, match="1..2"):
        mesh.tetrahedra(order=3)
    with pytest.raises(nacre.Error, match="element_order"):
        mesh.save(tmp_path / "a.stl")


def test_a_bound_on_the_deviation():
    mesh = nacre.mesh(two_balls(20), labels=True, max_size=3, epsilon=2, max_deviation=0.06)
    found = mesh.report["mesh"]["deviation"]
    assert found["met"] and found["max_voxels"] <= 0.06
    assert mesh.quality.sound and mesh.quality.distance_max < 0.061


def test_stages_and_a_changed_knob():
    run = nacre.meshing(two_balls(16), max_size=2.0)
    names, counts = [], []
    for stage in run:
        names.append(stage.name)
        if stage.name == "particles":
            counts.append(len(stage.particles.points))
            assert set(np.unique(stage.particles.order)) <= {0, 1, 2}
    assert names == ["fields", "particles", "triangles"]
    before = run.mesh
    run.max_size = 1.0
    run.min_size = 0.8
    assert (run.max_size, run.min_size) == (1.0, 0.8)
    assert [stage.name for stage in run] == ["fields", "particles", "triangles"]
    fresh = nacre.mesh(two_balls(16), max_size=1.0, min_size=0.8)
    assert run.mesh.points.tobytes() == fresh.points.tobytes()
    assert run.mesh.triangles.tobytes() == fresh.triangles.tobytes()
    assert len(before.points) != len(fresh.points)
    with pytest.raises(nacre.Error, match="gone on"):
        before.tetrahedra()
    run.smooth = 0
    assert [stage.name for stage in run] == ["triangles"]
    with pytest.raises(nacre.Error, match="cannot be changed"):
        run.min_component = 3
    with pytest.raises(AttributeError, match="no knob 'maxsize'"):
        run.maxsize = 3


def test_threads_do_not_change_results():
    one, two = (nacre.mesh(bean(), threads=n) for n in (1, 2))
    assert one.points.tobytes() == two.points.tobytes() and one.triangles.tobytes() == two.triangles.tobytes()


@pytest.mark.parametrize("dtype", ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8", ">i2", ">f4", "f2", "?"])
def test_types_and_byte_orders(dtype):
    labels = (two_balls(14) > 0).astype(dtype)
    expected = nacre.mesh((two_balls(14) > 0).astype(np.uint8), labels=True)
    assert nacre.mesh(labels, labels=True).points.tobytes() == expected.points.tobytes()


def test_orders_and_views():
    labels = bean()
    expected = nacre.mesh(labels).points.tobytes()
    assert nacre.mesh(labels.T, order="xyz").points.tobytes() == expected
    assert nacre.mesh(np.asfortranarray(labels)).points.tobytes() == expected
    wide = np.zeros((*labels.shape, 2), labels.dtype)
    wide[..., 1] = labels
    assert nacre.mesh(wide[..., 1]).points.tobytes() == expected
    labels.flags.writeable = False
    assert nacre.mesh(labels).points.tobytes() == expected
    assert nacre.mesh(labels.tolist()).points.tobytes() == expected
    assert nacre.mesh([labels[k] for k in range(len(labels))]).points.tobytes() == expected


def test_indicators():
    z, y, x = np.mgrid[:16, :16, :16].astype(np.float32)
    one = np.clip(6 - np.sqrt((x - 5.5) ** 2 + (y - 7.5) ** 2 + (z - 7.5) ** 2), 0, 1)
    two = np.clip(6 - np.sqrt((x - 9.5) ** 2 + (y - 7.5) ** 2 + (z - 7.5) ** 2), 0, 1) * (1 - one)
    assert nacre.mesh([one, two]).labels == [1, 2]


def test_lost_labels_are_warned_of():
    labels = two_balls(20)
    labels[2, 2, 2] = 9
    with pytest.warns(nacre.Warning, match="label 9 was lost") as caught:
        mesh = nacre.mesh(labels, min_size=8, max_size=8)
    assert caught[0].filename == __file__
    assert mesh.quality.lost_labels == [9]
