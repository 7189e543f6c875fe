# Nacre: labels to a solved heat equation, with scikit-fem on our tetrahedra.
"""Two tissues in a volume of labels: the outer one is cooled at its surface, the inner one is heated.

Usage: python heat.py [PICTURE.png]   (pip install nacre-mesh scikit-fem; pyvista for the picture)
The cells (# %%) can be run one by one in an editor or in Jupyter.
"""

# %% A volume of labels: a ball (2) in a ball (1), 0.5 mm voxels.
import sys

import numpy as np
import skfem
from skfem.helpers import dot, grad

import nacre

z, y, x = np.mgrid[:40, :40, :40] - 19.5
r = np.sqrt(x * x + y * y + z * z)
labels = np.zeros(r.shape, np.uint8)
labels[r < 16] = 1
labels[r < 8] = 2

# %% The mesh: conformal, so both tissues share the points of the interface between them.
mesh = nacre.mesh(labels, spacing=(0.5, 0.5, 0.5), max_size=1.5, names={1: "fat", 2: "muscle"})
cells = mesh.tetrahedra()
print(mesh, cells, mesh.quality, sep="\n")

# %% Linear elements; conductivity and heating per cell, by its label.
grid = skfem.MeshTet(cells.points.T, cells.cells.T)
basis = skfem.Basis(grid, skfem.ElementTetP1())
piecewise = basis.with_element(skfem.ElementTetP0())
conductivity = piecewise.zeros()
heating = piecewise.zeros()
conductivity[:] = np.where(cells.labels == 2, 5.0, 1.0)
heating[:] = np.where(cells.labels == 2, 1.0, 0.0)


@skfem.BilinearForm
def stiffness(u, v, w):
    return w.k * dot(grad(u), grad(v))


@skfem.LinearForm
def load(v, w):
    return w.q * v


# %% Temperature 0 where the mesh ends: at the triangles with the outside on one side.
border = np.unique(mesh.triangles[(mesh.materials == mesh.outside).any(axis=1)])
matrix = stiffness.assemble(basis, k=piecewise.interpolate(conductivity))
right = load.assemble(basis, q=piecewise.interpolate(heating))
heat = skfem.solve(*skfem.condense(matrix, right, D=border))

# %% Two balls of the same volumes have an exact solution.
corners = cells.points[cells.cells]
volume = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
a = np.cbrt(0.75 / np.pi * volume[cells.labels == 2].sum())
b = np.cbrt(0.75 / np.pi * volume.sum())
distance = np.linalg.norm(cells.points - cells.points[border].mean(axis=0), axis=1)
shell = a**3 / 3 * (1 / np.maximum(distance, a) - 1 / b)
exact = shell + np.where(distance < a, (a**2 - distance**2) / (6 * 5), 0)
error = np.abs(heat - exact).max() / exact.max()
print(f"warmest {heat.max():.4f}, exact {exact.max():.4f}; largest error {100 * error:.1f}% of that")
assert error < 0.03

# %% A picture, cut open.
if len(sys.argv) > 1:
    import pyvista

    solved = cells.to_pyvista()
    solved.point_data["temperature"] = heat
    plotter = pyvista.Plotter(off_screen=True, window_size=(640, 480))
    plotter.add_mesh(solved.clip("y", invert=False, crinkle=True), scalars="temperature", show_edges=True, cmap="inferno")
    plotter.camera_position = "xz"
    plotter.screenshot(sys.argv[1])
