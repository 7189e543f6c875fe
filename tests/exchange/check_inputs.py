"""Nacre: compares what `nacre info` says about files of others with what they are. Usage: check_inputs.py FOLDER"""

import json
import pathlib
import sys

import nibabel
import numpy as np

from make_inputs import NAMES, labels


def check_volume(path):
    info, image = json.loads(path.with_name(path.name + ".json").read_text())["volume"], nibabel.load(path)
    affine, axes, spacing = image.affine, np.array(info["axes"]), np.array(info["spacing"])
    assert np.allclose(affine[:3, :3], (axes * spacing[:, None]).T, atol=1e-6), f"{path.name}: axes {info['axes']}"
    assert np.allclose(affine[:3, 3], info["origin"], atol=1e-5), f"{path.name}: origin {info['origin']}"
    found = {entry["label"]: (entry["voxels"], entry["name"]) for entry in info["labels"] if entry["label"]}
    values = labels()
    expected = {label: (int((values == label).sum()), name) for label, name in NAMES.items()}
    assert found == expected, f"{path.name}: {found}, not {expected}"
    print(f"{path.name}: as nibabel wrote it")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    check_volume(folder / "labels.mgz")
    check_volume(folder / "labels.mgh")
    surface = json.loads((folder / "a.flow.gii.json").read_text())
    assert surface["triangles"] == 4 and surface["points"] == 4, surface
    assert [(a["name"], a["components"], a["max"]) for a in surface["arrays"]] == [("flow", 3, 1)], surface["arrays"]
    print("a.flow.gii: as nibabel wrote it")
    case = folder / "case/liver.foam.json"
    if case.stat().st_size:
        found = json.loads(case.read_text())
        assert found["triangles"] > 100 and found["times"] == [0.5, 1.5], found["times"]
        stress = [(a["components"], a["max"]) for a in found["arrays"] if a["name"] == "wallShearStress"]
        assert stress == [(3, 0.5)], f"liver.foam: {found['arrays']}"
        chosen = json.loads((folder / "kidney.json").read_text())
        assert set(found["parts"]) == {"outside_liver_bile", "outside_kidney_left"}, found["parts"]
        assert chosen["parts"] == ["outside_kidney_left"] and 50 < chosen["triangles"] < found["triangles"] - 50
        assert chosen["times"] == [0.5, 1.5]
        print("liver.foam: VTK finds its patches, chosen by name too, their wall shear stress and both steps")
    if (folder / "image.vtkhdf.json").stat().st_size:
        volume = json.loads((folder / "image.vtkhdf.json").read_text())["volume"]
        counts = {entry["label"]: entry["voxels"] for entry in volume["labels"]}
        assert counts == {int(v): int((labels() == v).sum()) for v in np.unique(labels())}, counts
        assert volume["dimensions"] == list(labels().shape) and np.allclose(volume["origin"], (-10, 20, 5))
        print("image.vtkhdf: as h5py wrote it")
