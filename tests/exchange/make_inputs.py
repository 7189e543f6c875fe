"""Nacre: makes volumes with named labels, as other programs write them. Usage: make_inputs.py FOLDER"""

import pathlib
import sys

import nibabel
import numpy as np

NAMES = {5: "liver & bile", 300: "kidney, left"}


def labels():
    """Two blocks with rounded corners that share a face; the axes are x, y, z."""
    x, y, z = np.meshgrid(*[np.arange(n) - n / 2 + 0.5 for n in (24, 20, 18)], indexing="ij")
    ball = (x / 9) ** 4 + (y / 7) ** 4 + (z / 6) ** 4 < 1
    return np.where(ball, np.where(x < 2, 5, 300), 0).astype(np.uint16)


def write_segmentation(path, values, names, spacing=(0.7, 0.8, 1.25), origin=(-10, 20, 5), directions=np.eye(3)):
    steps = [tuple(float(x) for x in s * np.asarray(d)) for s, d in zip(spacing, directions)]
    header = [
        "NRRD0004",
        "type: uint16",
        "dimension: 3",
        "space: left-posterior-superior",
        f"sizes: {' '.join(map(str, values.shape))}",
        "space directions: " + " ".join(str(step).replace(" ", "") for step in steps),
        f"space origin: {str(tuple(float(x) for x in origin)).replace(' ', '')}",
        "endian: little",
        "encoding: raw",
    ]
    for number, (label, name) in enumerate(names.items()):
        header += [f"Segment{number}_Name:={name}", f"Segment{number}_LabelValue:={label}"]
    path.write_bytes("\n".join(header).encode() + b"\n\n" + values.tobytes(order="F"))


def write_freesurfer(path, values):
    """The same volume, turned: the axes point to -x, -z and y, as FreeSurfer has them."""
    to_world = np.array([[-0.7, 0, 0, 12], [0, 0, 1.25, -9], [0, -0.8, 0, 30], [0, 0, 0, 1]])
    nibabel.save(nibabel.MGHImage(values.astype(np.int32), to_world), path)


def write_gifti(folder):
    """A tetrahedron, with a vector for each point in a file of its own."""
    array = nibabel.gifti.GiftiDataArray
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32)
    surface = [array(points, "NIFTI_INTENT_POINTSET"), array(triangles, "NIFTI_INTENT_TRIANGLE")]
    nibabel.save(nibabel.gifti.GiftiImage(darrays=surface), folder / "a.surf.gii")
    vectors = array(points[::-1].copy(), "NIFTI_INTENT_VECTOR", meta={"Name": "flow"})
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[*surface, vectors]), folder / "a.flow.gii")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    write_segmentation(folder / "labels.seg.nrrd", labels(), NAMES)
    write_freesurfer(folder / "labels.mgz", labels())
    write_freesurfer(folder / "labels.mgh", labels())
    write_gifti(folder)
    (folder / "names.txt").write_text("".join(f'{k} 255 0 0 1 1 1 "{v}"\n' for k, v in NAMES.items()))
