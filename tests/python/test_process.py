# Nacre: callbacks, threads, signals and processes.
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import torus, two_balls

import nacre

P, T, V = torus(24, 12)


def test_progress_is_told():
    told = []
    nacre.mesh(two_balls(16), progress=lambda *args: told.append(args))
    stages = [stage for stage, *_ in told]
    assert {"distance", "relax", "triangulate"} <= set(stages)
    fractions = [fraction for _, fraction, *_ in told]
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] <= 1
    assert all(isinstance(n, int) for *_, n, _ in told)


def test_progress_can_stop_a_run_that_goes_on_later():
    go = {"on": True}
    run = nacre.meshing(two_balls(16), progress=lambda *args: go["on"])
    next(run)
    go["on"] = False
    with pytest.raises(nacre.Interrupted):
        run.mesh
    assert run.stage == "fields"
    go["on"] = True
    assert run.mesh.points.tobytes() == nacre.mesh(two_balls(16)).points.tobytes()


def test_what_a_callback_raises_comes_out():
    def bad(*args):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        nacre.mesh(two_balls(16), progress=bad)
    with pytest.raises(ZeroDivisionError, match="mine"):
        nacre.flow(P, T, bad, times=[0, 1])
    calls = []

    def later(moment):
        calls.append(moment)
        if len(calls) > 4:
            raise ZeroDivisionError("later")
        return V

    with pytest.raises(ZeroDivisionError, match="later"):
        for _ in nacre.flow(P, T, later, times=np.linspace(0, 1, 9), resolution=64):
            pass


def test_a_callback_cannot_use_its_own_run():
    said = []

    def again(*args):
        if runs:
            with pytest.raises(nacre.Error) as caught:
                runs[0].mesh
            said.append(str(caught.value))

    runs = []
    run = nacre.meshing(two_balls(12), progress=again)
    runs.append(run)
    run.mesh
    assert said and all("busy" in s for s in said)


def test_two_threads_at_one_run_and_at_two():
    run = nacre.meshing(two_balls(28), max_size=0.6)
    thread = threading.Thread(target=lambda: run.mesh)
    thread.start()
    said = None
    while thread.is_alive() and said is None:
        try:
            next(run)
        except nacre.Error as error:
            said = str(error)
        except StopIteration:
            break
    thread.join()
    assert said is None or "busy" in said
    expected = nacre.mesh(two_balls(16)).points.tobytes()
    results = []
    threads = [threading.Thread(target=lambda: results.append(nacre.mesh(two_balls(16)).points.tobytes())) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 3


def test_other_threads_go_on():
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.005)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.monotonic()
    nacre.mesh(two_balls(100), max_size=0.7)
    took = time.monotonic() - began
    stop.set()
    thread.join()
    assert took > 0.3 and len(ticks) > 5 * took


@pytest.mark.parametrize("where", ["mesh", "flow"])
def test_ctrl_c(where):
    code = {
        "mesh": "nacre.mesh(two_balls(120), min_size=0.3, max_size=0.4)",
        "flow": "[frame.values for frame in nacre.flow(*torus(), resolution=1500, steps=1000)]",
    }[where]
    program = f"""
import sys; sys.path.insert(0, {os.path.dirname(__file__)!r})
import nacre
from conftest import two_balls, torus
print("begun", flush=True)
try:
    {code}
except KeyboardInterrupt:
    print("interrupted", len(nacre.mesh(two_balls(12)).points) > 0, flush=True)
"""
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    time.sleep(1.5)
    began = time.monotonic()
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=120)
    assert out == "interrupted True\n", out
    assert time.monotonic() - began < 60


def in_child(queue):
    try:
        queue.put(("made", nacre.mesh(two_balls(12)).points.tobytes()))
    except nacre.Error as error:
        queue.put(("error", str(error)))


def result_of(method):
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    process = context.Process(target=in_child, args=(queue,))
    process.start()
    result = queue.get(timeout=120)
    process.join(timeout=60)
    assert process.exitcode == 0
    return result


def test_a_forked_process_is_told_to_spawn():
    expected = nacre.mesh(two_balls(12)).points.tobytes()
    kind, text = result_of("fork")
    assert kind == "error" and "spawn" in text
    assert result_of("spawn") == ("made", expected)


def test_a_run_that_was_forked():
    run = nacre.meshing(two_balls(12))
    flow = nacre.flow(P, T, V, resolution=64)
    next(flow)
    child = os.fork()
    if child == 0:
        failed = 0
        for action in (lambda: run.mesh, lambda: next(flow), lambda: setattr(flow, "ttl", 3)):
            try:
                action()
            except nacre.Error as error:
                failed += "fork" in str(error)
        del run, flow
        os._exit(failed)
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 3
    assert len(run.mesh.points) > 0


def test_nothing_is_left_behind():
    program = f"""
import sys; sys.path.insert(0, {os.path.dirname(__file__)!r})
import importlib, nacre, nacre._core as core
from conftest import two_balls, torus
run = nacre.meshing(two_balls(12)); flow = nacre.flow(*torus(12, 8), resolution=64); frame = next(flow)
importlib.reload(nacre)
assert nacre._core is core
mesh = nacre.mesh(two_balls(12)); again = run.mesh
"""
    done = subprocess.run([sys.executable, "-X", "dev", "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "leaked" not in done.stderr and "Error" not in done.stderr
