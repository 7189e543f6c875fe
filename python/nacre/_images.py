# Nacre: volumes of numpy, SimpleITK, nibabel, pynrrd, VTK and PyVista with their geometry.
"""Volumes of numpy, SimpleITK, nibabel, pynrrd, VTK and PyVista with their geometry.

No package is imported that the caller has not imported: an image is known by what it can do.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import real_array, three
from ._errors import Error

_IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Volume:
    """Values with z first and x last, and where their voxels are."""

    def __init__(self, values: NDArray[Any]) -> None:
        self.values = values
        self.spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
        self.origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.axes: tuple[tuple[float, ...], ...] = _IDENTITY  # of x, y and z in the world
        self.names: dict[int, str] = {}
        self.name = "volume"


def _set_steps(volume: Volume, steps: NDArray[np.float64]) -> None:
    """`steps`: from voxel to voxel along x, y, z in the world, one per row."""
    lengths = np.linalg.norm(steps, axis=1)
    if not np.all(np.isfinite(lengths)) or np.any(lengths <= 0):
        raise Error("the image has an axis without length", "", "check its affine matrix or directions")
    volume.spacing = three(lengths, "the spacing")
    volume.axes = tuple(tuple(float(x) for x in row) for row in steps / lengths[:, None])


def _from_simpleitk(image: Any) -> Volume:
    sitk = importlib.import_module("SimpleITK")
    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise Error("the image is not a volume of single numbers", "", "give a 3D image with one component")
    volume = Volume(sitk.GetArrayViewFromImage(image))
    volume.spacing = three(image.GetSpacing(), "the spacing")
    volume.origin = three(image.GetOrigin(), "the origin")
    direction = np.asarray(image.GetDirection(), dtype=float).reshape(3, 3)
    volume.axes = tuple(tuple(float(x) for x in row) for row in direction.T)
    return volume


def _from_nibabel(image: Any) -> Volume:
    values = np.asanyarray(image.dataobj)
    if values.ndim == 4 and values.shape[3] == 1:
        values = values[..., 0]
    volume = Volume(values.T if values.ndim == 3 else values)
    affine = np.asarray(image.affine, dtype=float)
    _set_steps(volume, affine[:3, :3].T)
    volume.origin = three(affine[:3, 3], "the origin")
    return volume


def _from_pynrrd(data: NDArray[Any], header: Mapping[str, Any]) -> Volume:
    volume = Volume(data.T if data.ndim == 3 else data)  # nrrd.read has x first unless told otherwise
    if "sizes" in header and tuple(int(s) for s in header["sizes"]) != tuple(data.shape):
        volume.values = data  # read with index_order="C"
    if header.get("space directions") is not None:
        steps = np.asarray(header["space directions"], dtype=float)
        if steps.shape != (3, 3):
            raise Error("the NRRD header has no three directions in space", "", "give one 3D volume")
        _set_steps(volume, steps)
        if header.get("space origin") is not None:
            volume.origin = three(header["space origin"], "the origin")
    elif header.get("spacings") is not None:
        volume.spacing = three(header["spacings"], "the spacing")
    for key, label in header.items():
        if key.startswith("Segment") and key.endswith("_LabelValue"):
            name = header.get(key.replace("_LabelValue", "_Name"))
            if name:
                volume.names[int(label)] = str(name)
    return volume


def _from_vtk(image: Any) -> Volume:
    numpy_support = importlib.import_module("vtkmodules.util.numpy_support")
    size = np.asarray(image.GetDimensions())
    array, cells = image.GetPointData().GetScalars(), False
    if array is None:
        for data, is_cells in ((image.GetPointData(), False), (image.GetCellData(), True)):
            for k in range(data.GetNumberOfArrays()):
                if array is None and data.GetArray(k) is not None and data.GetArray(k).GetNumberOfComponents() == 1:
                    array, cells = data.GetArray(k), is_cells
    if array is None or array.GetNumberOfComponents() != 1:
        raise Error("the image has no array with one number per voxel")
    if cells:
        size = size - 1
    volume = Volume(numpy_support.vtk_to_numpy(array).reshape(tuple(int(n) for n in size[::-1])))
    volume.name = array.GetName() or "volume"
    volume.spacing = three(image.GetSpacing(), "the spacing")
    matrix = image.GetDirectionMatrix()
    direction = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    volume.axes = tuple(tuple(float(x) for x in row) for row in direction.T)
    first = np.asarray(image.GetExtent()[::2], dtype=float) + (0.5 if cells else 0.0)
    volume.origin = three(np.asarray(image.GetOrigin()) + direction @ (first * volume.spacing), "the origin")
    return volume


def _from_array(values: Any, order: str) -> Volume:
    array = real_array(values, "the volume")
    return Volume(array.T if order == "xyz" and array.ndim == 3 else array)


def _has(image: object, *names: str) -> bool:
    return all(hasattr(image, name) for name in names)


def _recognise(image: Any, order: str) -> Volume:
    if _has(image, "GetSpacing", "GetDirection", "GetPixelIDTypeAsString"):
        return _from_simpleitk(image)
    if _has(image, "affine", "dataobj"):
        return _from_nibabel(image)
    if _has(image, "GetDimensions", "GetDirectionMatrix", "GetPointData"):
        return _from_vtk(image)
    if isinstance(image, tuple) and len(image) == 2 and isinstance(image[1], Mapping):
        return _from_pynrrd(np.asarray(image[0]), image[1])
    return _from_array(image, order)


def _checked_values(values: NDArray[Any]) -> NDArray[Any]:
    values = real_array(values, "the volume")
    if values.ndim != 3:
        raise Error(f"the volume has shape {values.shape}", "", "give an array with three axes")
    if values.size == 0:
        raise Error("the volume is empty")
    if values.dtype == np.bool_:
        values = values.view(np.uint8)
    elif values.dtype.kind == "f" and values.dtype.itemsize not in (4, 8):
        values = values.astype(np.float32 if values.dtype.itemsize < 4 else np.float64)
    if not values.dtype.isnative:
        values = values.astype(values.dtype.newbyteorder("="))
    return np.ascontiguousarray(values)


def volumes_of(volume: Any) -> list[Any]:
    """The argument of `nacre.mesh` as a list of volumes: a list of images is several, nested lists of numbers are one."""
    stack = isinstance(volume, list) and len(volume) > 0 and isinstance(volume[0], (list, np.ndarray))
    several = isinstance(volume, list) and len(volume) > 0 and not (stack and np.ndim(volume[0]) < 3)
    return volume if several else [volume]


def volume_dict(
    image: Any,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    order: str = "zyx",
    names: Mapping[int, str] | None = None,
    name: str | None = None,
) -> dict[str, Any]:
    """The volume as the compiled part takes it; what is given beside the image goes before what it says itself."""
    if order not in ("zyx", "xyz"):
        raise Error(f"no order {order!r}", "", 'use "zyx" (the last axis is x) or "xyz" (the first axis is x)')
    volume = _recognise(image, order)
    if spacing is not None:
        volume.spacing = three(spacing, "spacing")
    if origin is not None:
        volume.origin = three(origin, "origin")
    if direction is not None:
        matrix = np.asarray(direction, dtype=float)
        if matrix.size != 9:
            raise Error(f"direction has shape {matrix.shape}", "", "it must be (3, 3): its columns are x, y and z")
        volume.axes = tuple(tuple(float(x) for x in row) for row in matrix.reshape(3, 3).T)
    if names:
        volume.names.update({int(label): str(text) for label, text in names.items()})
    return {
        "values": _checked_values(volume.values),
        "spacing": list(volume.spacing),
        "origin": list(volume.origin),
        "axes": [list(axis) for axis in volume.axes],
        "names": volume.names,
        "name": volume.name if name is None else str(name),
    }
