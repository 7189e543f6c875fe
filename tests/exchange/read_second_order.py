"""Nacre: has programs of others read meshes of second order, and compares volumes. Usage: read_second_order.py FOLDER"""

import json
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import gmsh
import meshio
import mfem.ser as mfem
import numpy as np
import pyfebio

NAMES = {5: "liver & bile", 300: "kidney, left"}
WORDS = {5: "liver_bile", 300: "kidney_left"}
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # of the nodes 4 to 9 in the order of VTK, Abaqus and FEBio


def jacobians(points, cells, at):
    """The determinant of the Jacobian of each cell at barycentric coordinates."""
    node = points[cells]
    along = [(4 * at[k] - 1) * node[:, k] for k in range(4)]
    for side, (i, j) in enumerate(EDGES):
        along[i] = along[i] + 4 * at[j] * node[:, 4 + side]
        along[j] = along[j] + 4 * at[i] * node[:, 4 + side]
    a, b, c, d = along
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)


def volumes(points, cells):
    """By a rule of degree 3, which is that of the determinant; nodes in another order would turn cells inside out."""
    assert cells.shape[1] == 10
    corner = jacobians(points, cells, (0.25, 0.25, 0.25, 0.25))
    total = -0.8 * corner
    for k in range(4):
        at = [1 / 6] * 4
        at[k] = 0.5
        here = jacobians(points, cells, at)
        assert here.min() > 0, "a cell is turned inside out"
        total += 0.45 * here
    assert corner.min() > 0
    return total / 6


def same(program, found, expected):
    assert found.keys() == expected.keys(), f"{program}: {sorted(found)}, not {sorted(expected)}"
    for label, value in expected.items():
        assert abs(found[label] / value - 1) < 1e-5, f"{program}: the volume of {label} is {found[label]}, not {value}"
    print(f"{program}: volumes agree: {', '.join(f'{k} {v:.6g}' for k, v in found.items())}")


def check_meshio(folder, expected):
    grid = meshio.read(folder / "curved.vtu")
    assert [block.type for block in grid.cells] == ["tetra10"]
    label = grid.cell_data["material"][0].ravel()
    size = volumes(grid.points, grid.cells[0].data)
    same("meshio curved.vtu", {k: size[label == k].sum() for k in expected}, expected)
    mesh = meshio.read(folder / "curved.inp")
    found = {}
    for label, word in WORDS.items():
        for block, cells in zip(mesh.cells, mesh.cell_sets[word]):
            if len(cells):
                assert block.type == "tetra10"
                found[label] = found.get(label, 0) + volumes(mesh.points, block.data[cells]).sum()
    same("meshio curved.inp", found, expected)
    for file in ("curved.msh", "curved.msh4"):
        mesh = meshio.read(folder / file, file_format="gmsh")
        found = dict.fromkeys(expected, 0)
        for block, groups in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            assert block.type in ("triangle6", "tetra10")
            if block.type == "tetra10":
                size = volumes(mesh.points, block.data)
                for label in found:
                    found[label] += size[groups == label].sum()
        same(f"meshio {file}", found, expected)


def check_gmsh(folder, expected):
    """Gmsh's own Jacobians, and its own bound on the least of them."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for file in ("curved.msh", "curved.msh4"):
        gmsh.open(str(folder / file))
        found = {}
        points, weights = gmsh.model.mesh.getIntegrationPoints(11, "Gauss4")
        for _, group in gmsh.model.getPhysicalGroups(3):
            for entity in gmsh.model.getEntitiesForPhysicalGroup(3, group):
                kinds, tags, _ = gmsh.model.mesh.getElements(3, entity)
                assert list(kinds) == [11], f"gmsh: elements of the types {kinds}"
                _, determinants, _ = gmsh.model.mesh.getJacobians(11, points, entity)
                found[group] = found.get(group, 0) + (np.reshape(determinants, (-1, len(weights))) @ weights).sum()
                least = min(gmsh.model.mesh.getElementQualities(tags[0], "minDetJac"))
                assert least > 0, f"gmsh: an element has the Jacobian {least}"
        same(f"gmsh {file}", found, expected)
        for _, group in gmsh.model.getPhysicalGroups(2):
            for entity in gmsh.model.getEntitiesForPhysicalGroup(2, group):
                assert list(gmsh.model.mesh.getElements(2, entity)[0]) == [9], "gmsh: triangles have no nodes"
    gmsh.finalize()


def check_mfem(folder, expected):
    for refine in (0, 1):  # 1 renumbers corners, and edges with them
        mesh = mfem.Mesh(str(folder / "curved.mesh"), 1, refine)
        assert mesh.GetNodalFESpace().FEColl().Name() == "H1_3D_P2"
        assert mesh.CheckElementOrientation(False) == 0 and mesh.CheckBdrElementOrientation(False) == 0
        found = dict.fromkeys(expected, 0)
        rule = mfem.IntRules.Get(mfem.Geometry.TETRAHEDRON, 3)  # GetElementVolume takes one that is not exact
        for i in range(mesh.GetNE()):
            cell = mesh.GetElementTransformation(i)
            for k in range(rule.GetNPoints()):
                cell.SetIntPoint(rule.IntPoint(k))
                assert cell.Weight() > 0, "mfem: a cell is turned inside out"
                found[mesh.GetAttribute(i)] += rule.IntPoint(k).weight * cell.Weight()
        same(f"mfem, refine={refine}", found, expected)


def check_febio(folder, expected):
    root = ElementTree.parse(folder / "curved.feb").getroot()
    mesh = pyfebio.mesh.Mesh.from_xml(ElementTree.tostring(root.find("Mesh")))
    points = np.array([np.array(node.text.split(","), float) for node in mesh.nodes[0].all_nodes])
    numbers = lambda entries: np.array([list(map(int, entry.text.split(","))) for entry in entries]) - 1
    assert {e.type for e in mesh.elements} == {"tet10"}
    label = {name: number for number, name in NAMES.items()}
    same("pyfebio", {label[e.name]: volumes(points, numbers(e.all_elements)).sum() for e in mesh.elements}, expected)
    for surface in mesh.surfaces:
        triangles = numbers(surface.all_tri6)
        for side in range(3):
            a, b = points[triangles[:, side]], points[triangles[:, (side + 1) % 3]]
            off = np.linalg.norm(points[triangles[:, 3 + side]] - (a + b) / 2, axis=1)
            assert (off < 0.31 * np.linalg.norm(b - a, axis=1)).all(), "pyfebio: a node is not on its edge"


def check_surface(folder):
    """The triangles alone: the same volumes within what cells pull back."""
    for file in ("shells.msh4", "shells.inp"):
        mesh = meshio.read(folder / file, file_format="gmsh" if file.endswith("4") else None)
        assert {block.type for block in mesh.cells} == {"triangle6"}, f"{file}: {mesh.cells}"
        for block in mesh.cells:
            for side in range(3):
                a, b = mesh.points[block.data[:, side]], mesh.points[block.data[:, (side + 1) % 3]]
                off = np.linalg.norm(mesh.points[block.data[:, 3 + side]] - (a + b) / 2, axis=1)
                assert (off < 0.31 * np.linalg.norm(b - a, axis=1)).all(), f"{file}: a node is not on its edge"
        print(f"meshio {file}: nodes are on their edges")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    report = json.loads((folder / "curved.json").read_text())["second_order"]
    expected = {entry["label"]: entry["volume"] for entry in report["materials"]}
    assert report["least_scaled_jacobian"] > 0 and report["on_surfaces"] > 0 and report["on_curves"] > 0
    check_meshio(folder, expected)
    check_gmsh(folder, expected)
    check_mfem(folder, expected)
    check_febio(folder, expected)
    check_surface(folder)
