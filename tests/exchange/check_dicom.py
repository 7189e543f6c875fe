"""Nacre: compares what the program reads from DICOM with the same volumes as NRRD. Usage: check_dicom.py FOLDER"""

import json
import pathlib
import sys

import meshio
import numpy as np
import trimesh

from make_inputs import labels


def read(folder, name):
    return json.loads((folder / f"{name}.json").read_text())


def same_place(a, b):
    for what in ("dimensions", "spacing", "axes", "origin"):
        assert np.allclose(a[what], b[what], atol=1e-6), f"{what}: {a[what]}, not {b[what]}"


def counts(volume):
    return {entry["label"]: (entry["voxels"], entry["name"]) for entry in volume["labels"] if entry["label"]}


def tetrahedra_by_label(file):
    grid = meshio.read(file)
    corners = grid.points[grid.cells_dict["tetra"]]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    return {int(k): volumes[grid.cell_data["material"][0].ravel() == k].sum() for k in np.unique(grid.cell_data["material"][0])}


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    truth = read(folder, "truth.seg.nrrd")["volume"]
    for name in ("series", "implicit"):
        volume = read(folder, name)["volume"]
        same_place(volume, truth)
        assert {k: n for k, (n, _) in counts(volume).items()} == {k: n for k, (n, _) in counts(truth).items()}
        assert (volume["type"], volume["min"], volume["max"]) == ("int16", 0, 300), volume
    ours, theirs = (trimesh.load(folder / f"{name}.ply", process=False) for name in ("series", "truth"))
    assert np.array_equal(ours.vertices, theirs.vertices) and np.array_equal(ours.faces, theirs.faces), "the mesh of the series is not that of the same volume as NRRD"
    print("a series: sorted, with its rescale, direction and spacing; its mesh is that of the NRRD, bit by bit")

    numbered = read(folder, "numbered.seg.nrrd")["volume"]
    segments = read(folder, "segments.dcm")["volume"]
    assert counts(segments) == counts(numbered), f"{counts(segments)}, not {counts(numbered)}"
    filled = np.flatnonzero((labels() > 0).any(axis=(0, 1)))
    step = np.array(numbered["axes"][2]) * numbered["spacing"][2]
    assert np.allclose(segments["origin"], np.array(numbered["origin"]) + filled[0] * step, atol=1e-5)
    found, expected = (tetrahedra_by_label(folder / f"{name}.vtu") for name in ("segments", "numbered"))
    for number in (1, 2):
        assert abs(found[number] / expected[number] - 1) < 0.02, f"{found}, not {expected}"
    print(f"a segmentation of highdicom: names, voxels and position; volumes {found}")

    overlapping = read(folder, "overlapping.dcm")
    assert "overlap" in overlapping["warnings"][0], overlapping["warnings"]
    assert counts(overlapping["volume"])[2] == counts(numbered)[2], "the later segment does not count where both are"
    print("overlapping segments: the later one counts, and a warning says so")
    assert "one is missing" in (folder / "gap.txt").read_text(), (folder / "gap.txt").read_text()
    assert "2 series" in (folder / "two.txt").read_text(), (folder / "two.txt").read_text()
    print("a missing slice, and two series in a folder, are refused")
