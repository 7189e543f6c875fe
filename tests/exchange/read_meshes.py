"""Nacre: has programs of others read the meshes, and compares volumes, areas and names. Usage: read_meshes.py FOLDER"""

import collections
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import gmsh
import meshio
import mfem.ser as mfem
import numpy as np
import Ofpp
import pyfebio
import trimesh

LIVER, KIDNEY, OUTSIDE = "liver & bile", "kidney, left", "outside"
LABELS = {5: LIVER, 300: KIDNEY}
WORDS = {LIVER: "liver_bile", KIDNEY: "kidney_left"}
INTERFACES = [f"{OUTSIDE} - {LIVER}", f"{OUTSIDE} - {KIDNEY}", f"{LIVER} - {KIDNEY}"]


def volumes(points, cells):
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def same(format, what, found, expected):
    assert found.keys() == expected.keys(), f"{format}: {what} are called {sorted(found)}, not {sorted(expected)}"
    for name, value in expected.items():
        assert abs(found[name] / value - 1) < 1e-5, f"{format}: {what} {name} is {found[name]}, not {value}"
    print(f"{format}: {what} agree: {', '.join(f'{k} {v:.4g}' for k, v in found.items())}")


def reference(folder):
    """Volumes by name of material and areas by name of interface, both from the cells of the .vtu."""
    grid = meshio.read(folder / "cells.vtu")
    cells, label = grid.cells_dict["tetra"], grid.cell_data["material"][0].ravel()
    volume = {name: volumes(grid.points, cells[label == l]).sum() for l, name in LABELS.items()}
    sides = collections.defaultdict(list)
    for cell, material in zip(cells, label):
        for left_out in range(4):
            sides[tuple(sorted(np.delete(cell, left_out)))].append(material)
    names = {0: OUTSIDE, **LABELS}
    area = collections.Counter()
    for face, materials in sides.items():
        a, b = sorted(materials if len(materials) == 2 else [0, *materials])
        if a != b:
            area[f"{names[a]} - {names[b]}"] += areas(grid.points, np.array([face]))[0]
    return volume, dict(area)


def check_meshio(folder, volume, area):
    for file, kind in (("cells.msh", "gmsh"), ("cells.msh4", "gmsh"), ("surface.msh4", "gmsh")):
        mesh = meshio.read(folder / file, file_format=kind)
        names = {tuple(tag): name for name, tag in mesh.field_data.items()}
        found = collections.Counter()
        for block, groups in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            dimension = {"triangle": 2, "tetra": 3}[block.type]
            sizes = (areas if dimension == 2 else volumes)(mesh.points, block.data)
            for group in np.unique(groups):
                found[names[group, dimension]] += sizes[groups == group].sum()
        same(f"meshio {file}", "groups", dict(found), {**area, **(volume if file[0] == "c" else {})})

    mesh = meshio.read(folder / "cells.inp")
    found = {}
    for name, members in mesh.cell_sets.items():
        for block, cells in zip(mesh.cells, members):
            if len(cells):
                found[name] = volumes(mesh.points, block.data[cells]).sum()
        used = np.unique(np.concatenate([b.data[c].ravel() for b, c in zip(mesh.cells, members) if len(c)]))
        assert np.array_equal(np.sort(mesh.point_sets[name]), used), f"{name}: NSET is not the points of ELSET"
    same("meshio cells.inp", "sets", found, {WORDS[k]: v for k, v in volume.items()})
    mesh = meshio.read(folder / "surface.inp")
    found = {n: sum(areas(mesh.points, b.data[c]).sum() for b, c in zip(mesh.cells, m) if len(c))
             for n, m in mesh.cell_sets.items()}
    words = lambda name: "_".join(WORDS.get(part, part) for part in name.split(" - "))
    same("meshio surface.inp", "sets", found, {words(k): v for k, v in area.items()})


def check_xdmf(folder, volume, area):
    for file, kind, array, expected in (
        ("cells.xdmf", "tetra", "material", volume),
        ("cells_interfaces.xdmf", "triangle", "interface", area),
        ("surface.xdmf", "triangle", "interface", area),
    ):
        mesh = meshio.read(folder / file)
        names = {tag: name for name, (tag, _) in mesh.field_data.items()}
        cells, groups = mesh.cells_dict[kind], mesh.cell_data[array][0].ravel()
        sizes = (volumes if kind == "tetra" else areas)(mesh.points, cells)
        same(f"meshio {file}", "groups", {names[g]: sizes[groups == g].sum() for g in np.unique(groups)}, expected)


def check_abaqus_surfaces(folder, area):
    """meshio leaves *SURFACE out."""
    faces = {"S1": (0, 1, 2), "S2": (0, 3, 1), "S3": (1, 3, 2), "S4": (2, 3, 0)}  # of C3D4, Abaqus manual
    points, elements, found, mode = {}, {}, collections.Counter(), ""
    for line in (folder / "cells.inp").read_text().splitlines():
        if line.startswith("*"):
            mode = line
        elif mode == "*NODE":
            number, *point = line.split(",")
            points[int(number)] = np.array(point, float)
        elif mode.startswith("*ELEMENT"):
            number, *corners = map(int, line.split(","))
            elements[number] = corners
        elif mode.startswith("*SURFACE"):
            element, face = line.split(", ")
            a, b, c = (points[elements[int(element)][k]] for k in faces[face])
            found[mode.split("NAME=")[1].split(",")[0]] += np.linalg.norm(np.cross(b - a, c - a)) / 2
    expected = {}
    for name, value in area.items():
        a, b = (WORDS.get(part, part) for part in name.split(" - "))
        expected |= {f"{here}_{there}": value for here, there in ((a, b), (b, a)) if here != OUTSIDE}
    same("cells.inp", "surfaces", dict(found), expected)


def check_calculix(folder):
    """A solver takes sets and surfaces: what is made in one material leaves through the other."""
    if not shutil.which("ccx"):
        print("ccx is left out: CalculiX is not installed")
        return
    mesh = meshio.read(folder / "cells.inp")
    made = 0
    for block, cells in zip(mesh.cells, mesh.cell_sets[WORDS[LIVER]]):
        if len(cells):  # a quarter of what a cell makes goes to each corner; what goes to a fixed one does not count
            free = ~np.isin(block.data[cells], mesh.point_sets[WORDS[KIDNEY]])
            made += (volumes(mesh.points, block.data[cells]) * free.sum(axis=1) / 4).sum()
    shutil.copy(pathlib.Path(__file__).with_name("heat.inp"), folder)
    said = subprocess.run(["ccx", "heat"], cwd=folder, capture_output=True, text=True).stdout
    assert "Job finished" in said, said[-2000:]
    lines = [line for line in (folder / "heat.dat").read_text().splitlines() if line.strip()]
    left = float(lines[next(i for i, line in enumerate(lines) if "total heat generation" in line) + 1])
    assert abs(-left / made - 1) < 1e-5, f"ccx: {left} leaves, {made} is made"
    assert any("LIVER_BILE_KIDNEY_LEFT" in line for line in lines), "ccx: no surface"
    print(f"ccx: {-left:.5g} of heat leaves, {made:.5g} is made")


def check_gmsh(folder, volume, area):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for file in ("cells.msh", "cells.msh4"):
        gmsh.open(str(folder / file))
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        points = np.zeros((int(tags.max()) + 1, 3))
        points[tags] = coordinates.reshape(-1, 3)
        found = {}
        for dimension, group in gmsh.model.getPhysicalGroups():
            total = 0
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
                _, _, corners = gmsh.model.mesh.getElements(dimension, entity)
                cells = corners[0].reshape(-1, dimension + 1)
                total += (areas if dimension == 2 else volumes)(points, cells).sum()
            found[gmsh.model.getPhysicalName(dimension, group)] = total
        same(f"gmsh {file}", "groups", found, {**area, **volume})
        if file.endswith("4"):
            up, down = gmsh.model.getAdjacencies(3, 300)
            assert sorted(map(abs, down)) == [2, 3], f"gmsh: interfaces {down} bound the kidney"
    gmsh.finalize()


def check_mfem(folder, volume, area):
    mesh = mfem.Mesh(str(folder / "cells.mesh"), 1, 1)
    assert mesh.CheckElementOrientation(False) == 0 and mesh.CheckBdrElementOrientation(False) == 0
    points = np.array([mesh.GetVertexArray(i) for i in range(mesh.GetNV())])
    found = {}
    for number, label in enumerate(LABELS):
        name = list(LABELS.values())[number]
        attributes = mesh.attribute_sets.GetAttributeSet(name)
        assert [attributes[0]] == [label]
        cells = [i for i in range(mesh.GetNE()) if mesh.GetAttribute(i) == label]
        found[name] = sum(mesh.GetElementVolume(i) for i in cells)
    same("mfem", "attributes", found, volume)
    found = {}
    for name in area:
        attribute = mesh.bdr_attribute_sets.GetAttributeSet(name)[0]
        faces = [mesh.GetBdrElementVertices(i) for i in range(mesh.GetNBE()) if mesh.GetBdrAttribute(i) == attribute]
        found[name] = areas(points, np.array(faces)).sum()
    same("mfem", "boundary attributes", found, area)


def check_febio(folder, volume, area):
    root = ElementTree.parse(folder / "cells.feb").getroot()
    mesh = pyfebio.mesh.Mesh.from_xml(ElementTree.tostring(root.find("Mesh")))
    points = np.array([np.array(node.text.split(","), float) for node in mesh.nodes[0].all_nodes])
    numbers = lambda entries: np.array([list(map(int, entry.text.split(","))) for entry in entries]) - 1
    same("pyfebio", "parts", {e.name: volumes(points, numbers(e.all_elements)).sum() for e in mesh.elements}, volume)
    surfaces = {s.name: areas(points, numbers(s.all_tri3)).sum() for s in mesh.surfaces}
    expected = dict(area)
    expected[f"{KIDNEY} - {LIVER}"] = area[f"{LIVER} - {KIDNEY}"]
    same("pyfebio", "surfaces", surfaces, expected)
    pairs = [(p.primary, p.secondary) for p in mesh.surface_pairs]
    assert pairs == [(f"{LIVER} - {KIDNEY}", f"{KIDNEY} - {LIVER}")], pairs


def check_openfoam(folder, volume, area):
    """Ofpp reads; the order of faces and the closedness of cells are computed as checkMesh does."""
    case = folder / "case"
    mesh = Ofpp.FoamMesh(str(case))
    points, faces = np.array(mesh.points), np.array(mesh.faces)
    owner, neighbour = np.array(mesh.owner), np.array(mesh.neighbour)
    inner = mesh.num_inner_face
    a, b, c = (points[faces[:, k]] for k in range(3))
    normal, centre = np.cross(b - a, c - a) / 2, (a + b + c) / 3
    inside = neighbour[:inner]
    assert (owner[:inner] < inside).all(), "a face belongs to the higher cell"
    order = list(zip(owner[:inner], inside))
    assert order == sorted(order), "the faces are not in upper-triangular order"
    cells = max(owner.max(), inside.max()) + 1
    total, size = np.zeros((cells, 3)), np.zeros(cells)
    flux = np.einsum("ij,ij->i", normal, centre) / 3
    np.add.at(total, owner, normal)
    np.add.at(total, inside, -normal[:inner])
    np.add.at(size, owner, flux)
    np.add.at(size, inside, -flux[:inner])
    assert np.abs(total).max() < 1e-9 and size.min() > 0, "a cell is open or turned inside out"
    assert abs(size.sum() / sum(volume.values()) - 1) < 1e-9
    expected = {f"{OUTSIDE}_{WORDS[n]}": area[f"{OUTSIDE} - {n}"] for n in LABELS.values()}
    found = {}
    for name, patch in mesh.boundary.items():
        members = slice(patch.start, patch.start + patch.num)
        found[name.decode()] = np.linalg.norm(normal[members], axis=1).sum()
    same("Ofpp", "patches", found, expected)


def check_gltf(folder, area):
    scene = trimesh.load_scene(folder / "surface.glb")
    found, low, high = {}, [], []
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        found[node] = scene.geometry[geometry].copy().apply_transform(transform).area
    same("trimesh", "meshes", found, area)
    ours = meshio.read(folder / "cells.vtu").points
    turned = np.stack([ours[:, 0], ours[:, 2], -ours[:, 1]], axis=1)
    assert np.allclose(scene.bounds, [turned.min(axis=0), turned.max(axis=0)], atol=1e-4), "it is not where it was"


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    volume, area = reference(folder)
    assert set(area) == set(INTERFACES)
    check_meshio(folder, volume, area)
    check_abaqus_surfaces(folder, area)
    check_calculix(folder)
    check_gmsh(folder, volume, area)
    check_xdmf(folder, volume, area)
    check_mfem(folder, volume, area)
    check_febio(folder, volume, area)
    check_openfoam(folder, volume, area)
    check_gltf(folder, area)
