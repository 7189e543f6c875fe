# Nacre: arrays of others than numpy: buffers, DLPack, the GPU.
import array

import numpy as np
import pytest
from conftest import torus, two_balls

import nacre
from nacre._arrays import real_array


class OnlyDlpack:
    """What a library of arrays without `__array__` shows."""

    def __init__(self, values):
        self._values = values

    def __dlpack__(self, **options):
        return self._values.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._values.__dlpack_device__()


class OnGpu:
    """An array that is not in the CPU's memory, and does not come there by itself."""

    def __dlpack__(self, **options):
        raise BufferError("the array is on the device")

    def __dlpack_device__(self):
        return (2, 0)


class ComesFromGpu(OnGpu):
    """One that is copied if it is asked to."""

    def __init__(self, values):
        self._values = values

    def __dlpack__(self, *, dl_device=None, **options):
        if dl_device is None or int(dl_device[0]) != 1:
            raise BufferError("the array is on the device")
        options.pop("copy", None)
        return self._values.__dlpack__(**options)


def test_arrays_by_dlpack_are_not_copied():
    labels = two_balls()
    assert np.shares_memory(real_array(OnlyDlpack(labels), "labels"), labels)
    expected = nacre.mesh(labels)
    assert np.array_equal(nacre.mesh(OnlyDlpack(labels)).points, expected.points)


def test_flow_takes_dlpack_and_buffers():
    points, triangles, velocity = torus(24, 12)
    options = {"resolution": 48, "steps": 1, "warmup": 1, "width": 64, "height": 48}
    expected = next(nacre.flow(points, triangles, velocity, **options)).values.value
    flow = nacre.flow(OnlyDlpack(points), memoryview(np.ascontiguousarray(triangles)), OnlyDlpack(velocity), **options)
    assert np.array_equal(next(flow).values.value, expected)


def test_a_buffer_of_the_standard_library():
    queries = memoryview(array.array("d", [0, 0, 5, 0, 0, -5])).cast("B").cast("d", shape=[2, 3])
    points, triangles, _ = torus(24, 12)
    found = nacre.closest_points(points, triangles, queries)
    assert np.allclose(np.linalg.norm(found.points - np.asarray(queries), axis=1), found.distance)


def test_an_array_on_a_gpu():
    with pytest.raises(nacre.Error) as caught:
        nacre.mesh(OnGpu())
    assert ".cpu()" in caught.value.advice
    if np.lib.NumpyVersion(np.__version__) >= "2.1.0":
        labels = two_balls()
        assert np.array_equal(nacre.mesh(ComesFromGpu(labels)).points, nacre.mesh(labels).points)


def test_results_go_out_by_dlpack(ball_mesh):
    assert np.shares_memory(np.from_dlpack(ball_mesh.points), ball_mesh.points)
