# Nacre: a flow of several processes, by mpi4py, gives what one process gives.
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import torus

import nacre

SCRIPT = """
import sys

import numpy as np
from mpi4py import MPI

import nacre
from conftest import torus

comm, what, to = MPI.COMM_WORLD, sys.argv[1], sys.argv[2]
points, triangles, velocity = torus()
if what == "other" and comm.rank == 1:
    points = points * 1.01
flow = nacre.flow(points, triangles, velocity, method="octree", resolution=128, width=320, height=240, steps=3,
                  seed=4, comm=comm)
for frame in flow:
    image = frame.image
    if what == "raise" and comm.rank == 1:
        raise ZeroDivisionError("mine")
values = comm.gather(frame.values.value)
frame.save(f"{to}/frame.png")
frame.save(f"{to}/pieces.pvtp")
report = flow.report
np.savez(f"{to}/{comm.rank}.npz", image=image, samples=frame.sample(points))
if comm.rank == 0:
    assert report["processes"]["count"] == comm.size
    np.save(f"{to}/values.npy", np.concatenate(values))
"""


@pytest.fixture
def on_processes(tmp_path):
    """Runs the script on so many processes."""
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("there is no mpirun (Debian: openmpi-bin)")
    pytest.importorskip("mpi4py.MPI", exc_type=(ImportError, RuntimeError))
    (tmp_path / "script.py").write_text(SCRIPT)

    def run(count, what):
        here = os.path.dirname(__file__)
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "PYTHONPATH": here, "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
                       "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        return subprocess.run([mpirun, "-n", str(count), sys.executable, "-m", "mpi4py", tmp_path / "script.py", what,
                               tmp_path], env=environment, capture_output=True, text=True, timeout=600)

    return run


def test_several_processes_give_what_one_gives(on_processes, tmp_path):
    points, triangles, velocity = torus()
    flow = nacre.flow(points, triangles, velocity, method="octree", resolution=128, width=320, height=240, steps=3, seed=4)
    for frame in flow:
        pass
    done = on_processes(3, "same")
    assert done.returncode == 0, done.stderr
    for rank in range(3):
        theirs = np.load(tmp_path / f"{rank}.npz")
        assert np.array_equal(theirs["image"], frame.image)
        assert np.array_equal(theirs["samples"], frame.sample(points))
        assert (tmp_path / f"pieces_{rank}.vtp").exists()
    assert np.array_equal(np.load(tmp_path / "values.npy"), frame.values.value)
    assert (tmp_path / "frame.png").stat().st_size > 1000


def test_errors_end_all_processes(on_processes):
    done = on_processes(2, "other")
    assert done.returncode != 0 and "another input" in done.stderr
    done = on_processes(2, "raise")
    assert done.returncode != 0 and "ZeroDivisionError: mine" in done.stderr


def test_only_a_communicator_will_do():
    points, triangles, velocity = torus()
    with pytest.raises(nacre.Error, match="comm"):
        nacre.flow(points, triangles, velocity, comm="world")
