# Nacre: what PyVista and meshio find: the accessor, readers and writers.
import subprocess
import sys

import numpy as np
import pytest
from conftest import bean, torus

import nacre

pyvista = pytest.importorskip("pyvista", minversion="0.48")
NAMES = {3: "liver", 9: "cyst", -4: "vessel"}


def image():
    volume = pyvista.ImageData(dimensions=bean().T.shape, spacing=(0.7, 0.8, 1.25), origin=(1, 2, 3))
    volume.point_data["labels"] = bean().ravel()
    return volume


def test_nothing_has_to_be_imported():
    code = "import pyvista, sys; p = pyvista.ImageData(dimensions=(4, 4, 4)); a = p.nacre; print(type(a).__module__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "nacre._pyvista", done.stderr


def test_meshes():
    expected = nacre.mesh(image(), max_size=1.5, names=NAMES)
    surface = image().nacre.mesh(max_size=1.5, names=NAMES)
    assert np.array_equal(surface.points, expected.points)
    assert np.array_equal(surface.regular_faces, expected.triangles)
    grid = image().nacre.tetrahedra(max_size=1.5, names=NAMES)
    assert np.array_equal(grid.cell_data["material"], expected.tetrahedra().labels)
    assert dict(zip(grid.field_data["material_labels"], grid.field_data["material_names"])) == {0: "outside", **NAMES}
    assert [stage.name for stage in image().nacre.meshing(max_size=1.5)] == ["fields", "particles", "triangles"]


def test_flow_and_closest_points():
    points, triangles, velocity = torus(24, 12)
    surface = pyvista.PolyData.from_regular_faces(points, triangles)
    surface.point_data["wind"] = velocity
    frame = next(surface.nacre.flow("wind", resolution=48, steps=1, warmup=1))
    assert frame.values.value.std() > 0.05
    found = surface.nacre.closest_points([[0, 0, 5]])
    assert found.distance[0] == pytest.approx(nacre.closest_points(points, triangles, [[0, 0, 5]]).distance[0], rel=1e-6)


@pytest.mark.parametrize("extension", [".msh", ".inp", ".mesh", ".feb", ".foam", ".msh4"])
def test_save_writes_files_for_solvers(extension, tmp_path):
    grid = image().nacre.tetrahedra(max_size=2, names=NAMES)
    file = tmp_path / f"bean{extension}"
    grid.save(file)
    assert file.exists()
    if extension == ".feb":
        assert all(name in file.read_text() for name in NAMES.values())


def test_groups_are_those_of_the_mesh(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = nacre.mesh(image(), max_size=2, names=NAMES)
    cells = mesh.tetrahedra()
    cells.save(tmp_path / "ours.msh")
    cells.to_pyvista().save(tmp_path / "theirs.msh")
    ours, theirs = (meshio.read(tmp_path / f"{name}.msh", file_format="gmsh") for name in ("ours", "theirs"))
    assert {k: list(v) for k, v in ours.field_data.items()} == {k: list(v) for k, v in theirs.field_data.items()}

    def sizes(read):
        result = {}
        for block, tags in zip(read.cells, read.cell_data["gmsh:physical"]):
            for tag in np.unique(tags):
                corners = read.points[block.data[tags == tag]]
                edges = corners[:, 1:] - corners[:, :1]
                size = np.linalg.det(edges) / 6 if block.type == "tetra" else np.linalg.norm(np.cross(*np.moveaxis(edges, 1, 0)), axis=1) / 2
                assert block.type != "tetra" or np.all(size > 0)
                result[block.type, int(tag)] = size.sum()
        return result

    assert sizes(ours) == pytest.approx(sizes(theirs))
    assert len(sizes(ours)) > 5


def test_cells_turned_inside_out_are_turned_back(tmp_path):
    meshio = pytest.importorskip("meshio")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]], float)
    nacre.save_tetrahedra(tmp_path / "two.msh", points, [[0, 1, 2, 3], [0, 1, 2, 4]], [7, 0])
    read = meshio.read(tmp_path / "two.msh", file_format="gmsh")
    corners = read.points[read.cells_dict["tetra"]]
    assert np.linalg.det(corners[:, 1:] - corners[:, :1]) == pytest.approx([1, 1])
    assert sum(len(block.data) for block in read.cells if block.type == "triangle") == 7


@pytest.mark.parametrize(
    "cells, labels, why",
    [
        ([[0, 1, 2, 9]], None, "outside"),
        ([[0, 1, 2, 2]], None, "no volume"),
        ([[0, 1, 2, 3]], [1, 2], "labels"),
        (np.empty((0, 4), int), None, "no tetrahedra"),
        ([[0, 1, 2, 3]] * 3, None, "more than two"),
    ],
)
def test_bad_cells(cells, labels, why, tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    with pytest.raises(nacre.Error, match=why):
        nacre.save_tetrahedra(tmp_path / "bad.msh", points, cells, labels)
    assert not list(tmp_path.iterdir())


def test_other_datasets_say_what_is_wrong(tmp_path):
    with pytest.raises(nacre.Error, match="no tetrahedra"):
        pyvista.Sphere().save(tmp_path / "sphere.feb")
    with pytest.raises(nacre.Error, match="no linear tetrahedra"):
        image().cast_to_unstructured_grid().save(tmp_path / "cubes.feb")
    with pytest.raises(nacre.Error, match="no cell array"):
        image().nacre.tetrahedra(max_size=2).nacre.save(tmp_path / "a.feb", labels="tissue")


@pytest.mark.parametrize("extension", [".mgz", ".mgh"])
def test_volumes_of_freesurfer(extension, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    affine = np.array([[-0.7, 0, 0, 12], [0, 0, 1.25, -9], [0, -0.8, 0, 30], [0, 0, 0, 1]])
    file = tmp_path / f"bean{extension}"
    nibabel.save(nibabel.MGHImage(bean().T.astype(np.int32), affine), file)
    read = pyvista.read(file)
    assert np.array_equal(read.point_data["labels"], bean().ravel())
    ours, theirs = nacre.mesh(read, max_size=2), nacre.mesh(nibabel.load(file), max_size=2)
    assert np.allclose(ours.points, theirs.points, atol=1e-4) and np.array_equal(ours.triangles, theirs.triangles)
    damaged = tmp_path / f"damaged{extension}"
    damaged.write_bytes(file.read_bytes()[:200])
    with pytest.raises(nacre.Error, match="cannot read"):
        pyvista.read(damaged)


def test_meshio_writes_more(tmp_path):
    meshio = pytest.importorskip("meshio")
    nacre.register_meshio()
    mesh = nacre.mesh(image(), max_size=2).tetrahedra().to_meshio()
    for extension in (".feb", ".foam", ".msh4"):
        meshio.write(tmp_path / f"bean{extension}", mesh)
        assert (tmp_path / f"bean{extension}").exists()
    with pytest.raises(nacre.Error, match="no linear tetrahedra"):
        meshio.write(tmp_path / "surface.feb", nacre.mesh(image(), max_size=2).to_meshio())
