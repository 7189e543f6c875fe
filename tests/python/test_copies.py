# Nacre: what can be copied and pickled, and what says that it cannot.
import copy
import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import torus, two_balls

import nacre


def same(a, b):
    return np.array_equal(a.points, b.points) and np.array_equal(a.triangles, b.triangles) and np.array_equal(
        a.materials, b.materials) and a.names == b.names and a.labels == b.labels


def test_a_mesh_is_pickled_with_what_is_known_of_it(ball_mesh, tmp_path):
    twin = pickle.loads(pickle.dumps(ball_mesh))
    assert same(twin, ball_mesh)
    assert twin.quality == ball_mesh.quality
    assert twin.report.keys() == ball_mesh.report.keys() and twin.report["input"] == ball_mesh.report["input"]
    ball_mesh.save(tmp_path / "a.vtp")
    twin.save(tmp_path / "b.vtp")
    assert (tmp_path / "a.vtp").read_bytes() == (tmp_path / "b.vtp").read_bytes()
    with pytest.raises(nacre.Error, match="pickled"):
        twin.tetrahedra()
    assert same(pickle.loads(pickle.dumps(twin)), ball_mesh)


def test_tetrahedra_are_pickled(ball_mesh, tmp_path):
    cells = ball_mesh.tetrahedra()
    twin = pickle.loads(pickle.dumps(cells))
    assert np.array_equal(twin.cells, cells.cells) and np.array_equal(twin.labels, cells.labels)
    cells.save(tmp_path / "a.msh")
    twin.save(tmp_path / "b.msh")
    assert (tmp_path / "a.msh").read_bytes() == (tmp_path / "b.msh").read_bytes()


@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy])
def test_a_copy_of_a_mesh_is_independent_and_can_be_filled(ball_mesh, how):
    twin = how(ball_mesh)
    assert same(twin, ball_mesh)
    assert not np.shares_memory(twin.points, ball_mesh.points)
    assert len(twin.tetrahedra().cells) == len(ball_mesh.tetrahedra().cells)


def _mesh_elsewhere(size):
    mesh = nacre.mesh(two_balls(size), triangulation="delaunay")
    return mesh, mesh.tetrahedra(), next(iter(nacre.meshing(two_balls(size)))).name


def test_results_come_from_other_processes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        mesh, cells, stage = pool.apply(_mesh_elsewhere, (16,))
    assert same(mesh, nacre.mesh(two_balls(16), triangulation="delaunay")) and len(cells.cells) > 100 and stage == "fields"


def test_particles_and_quality(ball_mesh):
    run = nacre.meshing(two_balls(16))
    for stage in run:
        if stage.name == "particles":
            break
    particles = pickle.loads(pickle.dumps(run.particles))
    assert np.array_equal(particles.points, run.particles.points)
    assert copy.deepcopy(ball_mesh.quality) == ball_mesh.quality


def test_runs_say_that_they_cannot():
    points, triangles, velocity = torus(24, 12)
    flow = nacre.flow(points, triangles, velocity, resolution=48, steps=1, warmup=1)
    for thing in (nacre.meshing(two_balls(16)), flow, next(flow)):
        for how in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(nacre.Error, match="pickled or copied"):
                how(thing)
