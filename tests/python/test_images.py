# Nacre: images of other packages bring their geometry; meshes go to other packages.
import numpy as np
import pytest
from conftest import bean, torus

import nacre

SPACING, ORIGIN = np.array((0.7, 0.8, 1.25)), np.array((1.0, 2.0, -3.0))
TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # columns: where x, y, z point


@pytest.fixture(scope="module")
def straight():
    return nacre.mesh(bean())


@pytest.fixture(scope="module")
def turned():
    return nacre.mesh(bean(), spacing=SPACING, origin=ORIGIN, direction=TURN)


def test_the_geometry_is_where_it_is_said_to_be(straight, turned):
    low, high = straight.points.min(0), straight.points.max(0)
    corners = [ORIGIN + TURN @ (SPACING * corner) for corner in (low, high)]
    assert np.allclose(turned.points.min(0), np.minimum(*corners), atol=0.5)
    assert np.allclose(turned.points.max(0), np.maximum(*corners), atol=0.5)


def test_simpleitk(turned):
    sitk = pytest.importorskip("SimpleITK")
    image = sitk.GetImageFromArray(bean())
    image.SetSpacing(SPACING.tolist())
    image.SetOrigin(ORIGIN.tolist())
    image.SetDirection(TURN.ravel().tolist())
    assert nacre.mesh(image).points.tobytes() == turned.points.tobytes()
    with pytest.raises(nacre.Error, match="3D"):
        nacre.mesh(sitk.GetImageFromArray(np.zeros((5, 5), np.uint8)))


def test_nibabel(turned, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    affine = np.eye(4)
    affine[:3, :3] = TURN * SPACING
    affine[:3, 3] = ORIGIN
    image = nibabel.Nifti1Image(bean().T, affine)
    nibabel.save(image, tmp_path / "bean.nii.gz")
    for each in (image, nibabel.load(tmp_path / "bean.nii.gz")):
        mesh = nacre.mesh(each)
        assert np.allclose(mesh.points, turned.points, atol=1e-4) and np.array_equal(mesh.triangles, turned.triangles)


def test_pynrrd(turned, tmp_path):
    nrrd = pytest.importorskip("nrrd")
    header = {
        "space": "right-anterior-superior",
        "space directions": (TURN * SPACING).T,
        "space origin": ORIGIN,
        "Segment0_Name": "kidney",
        "Segment0_LabelValue": "9",
    }
    nrrd.write(str(tmp_path / "bean.nrrd"), bean().T, header)
    for order in ("F", "C"):
        mesh = nacre.mesh(nrrd.read(str(tmp_path / "bean.nrrd"), index_order=order))
        assert np.allclose(mesh.points, turned.points, atol=1e-9)
        assert np.array_equal(mesh.triangles, turned.triangles)
        assert mesh.names[9] == "kidney"


def test_pyvista_image(turned):
    pyvista = pytest.importorskip("pyvista")
    image = pyvista.ImageData(dimensions=bean().T.shape, spacing=SPACING, origin=ORIGIN)
    image.direction_matrix = TURN
    image.point_data["labels"] = bean().ravel()
    assert np.allclose(nacre.mesh(image).points, turned.points, atol=1e-9)
    cells = pyvista.ImageData(dimensions=np.add(bean().T.shape, 1), spacing=SPACING)
    cells.direction_matrix = TURN
    cells.origin = ORIGIN - TURN @ (SPACING / 2)
    cells.cell_data["labels"] = bean().ravel()
    assert np.allclose(nacre.mesh(cells).points, turned.points, atol=1e-9)
    plain = pyvista.ImageData(dimensions=(4, 4, 4))
    with pytest.raises(nacre.Error, match="no array"):
        nacre.mesh(plain)


def test_to_pyvista_and_meshio(straight, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    meshio = pytest.importorskip("meshio")
    surface = straight.to_pyvista()
    assert surface.n_cells == len(straight.triangles)
    assert np.array_equal(surface.cell_data["material_1"], straight.materials[:, 1])
    filled = straight.tetrahedra()
    grid = filled.to_pyvista()
    for entry in straight.report["mesh"]["materials"]:
        part = grid.extract_cells(grid.cell_data["material"] == entry["label"])
        assert part.volume == pytest.approx(entry["volume"], rel=1e-6)
    filled.to_meshio().write(tmp_path / "mesh.vtu")
    assert len(meshio.read(tmp_path / "mesh.vtu").cells_dict["tetra"]) == len(filled.cells)
    assert len(straight.to_meshio().cells_dict["triangle"]) == len(straight.triangles)
    straight.save(tmp_path / "ours.vtu")
    read = pyvista.read(tmp_path / "ours.vtu")
    assert np.array_equal(read.cell_data["material"], filled.labels)
    run = nacre.meshing(bean())
    next(run), next(run)
    assert run.particles.to_pyvista().n_points == len(run.particles.points)


def test_flow_on_a_polydata():
    pyvista = pytest.importorskip("pyvista")
    points, triangles, velocity = torus()
    surface = pyvista.PolyData.from_regular_faces(points, triangles)
    surface.point_data["wind"] = velocity
    surface.point_data["height"] = points[:, 2]
    small = dict(resolution=96, width=160, height=120)
    expected = next(nacre.flow(points, triangles, velocity, vector_name="wind", **small)).image
    assert np.array_equal(next(nacre.flow(surface, velocity="wind", **small)).image, expected)
    next(nacre.flow(surface, velocity="wind", color="height", **small)).image
    with pytest.raises(nacre.Error, match="no point array 'sun'"):
        nacre.flow(surface, velocity="sun")
    camera = pyvista.Camera()
    camera.position, camera.focal_point, camera.up = (0, -9, 3), (0, 0, 0), (0, 0, 1)
    frame = next(nacre.flow(points, triangles, velocity, **small))
    assert frame.render(camera=camera)[..., :3].std() > 5
