"""Nacre: how a texture in pictures follows the flow, and how it stays on the surface; for run.sh, run by pvpython.

texture_on_points.py SURFACE.vtp CAMERAS.json FOLDER NAME

Takes FOLDER/NAME-K.png and FOLDER/NAME-K-plain.png of the first two cameras (orthographic). The light is taken out by
division, and what varies over more than 10 pixels, too. Points are drawn on the surface by area, seen by both cameras and not edge-on. Tells
  difference   mean absolute difference of brightness at the same points, over the mean absolute deviation of brightness
  correlation  of the brightness at the same points
  angle        median angle in degrees, in the picture, between the projected flow and the streaks: across the direction of
               most change of the structure tensor, Gaussian of 3 pixels
"""
import json
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

import read_vtp

SPREAD = 3.0  # pixels of the Gaussian, as in the evidence tests texture cells


def brightness(path):
    """Mean of the colours of a picture, first row at the top."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)
    return values[::-1, :, :3].mean(axis=2)


class View:
    """Where points of the world land in a picture."""

    def __init__(self, camera, shape):
        eye, target, up = (np.array(camera[k], float) for k in ("eye", "target", "up"))
        self.forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(self.forward, up)
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)
        self.target, self.shape, self.scale = target, shape, shape[0] / camera["height"]

    def place(self, points):
        """Pixels (x to the right, y down, centres at whole numbers) and depth."""
        d = points - self.target
        x = d @ self.right * self.scale + self.shape[1] / 2 - 0.5
        y = self.shape[0] / 2 - 0.5 - d @ self.up * self.scale
        return x, y, d @ self.forward

    def direction(self, vectors):
        return vectors @ self.right, -(vectors @ self.up)


def draw_points(points, triangles, vectors, count, seed):
    """Places, unit normals and vectors at random places of the surface."""
    random = np.random.default_rng(seed)
    corner = points[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = np.linalg.norm(normal, axis=1)
    chosen = random.choice(len(triangles), count, p=area / area.sum())
    weight = random.dirichlet((1, 1, 1), count)[:, :, None]
    place = (corner[chosen] * weight).sum(axis=1)
    return place, normal[chosen] / area[chosen, None], (vectors[triangles[chosen]] * weight).sum(axis=1)


def seen(view, place, normal):
    """Which of the points nothing hides, by the nearest of all points in each block of 2 pixels; well inside, not edge-on."""
    x, y, depth = view.place(place)
    height, width = view.shape
    inside = (x > 16) & (x < width - 17) & (y > 16) & (y < height - 17)
    column, row = (np.clip(x / 2, 0, width // 2 - 1)).astype(int), (np.clip(y / 2, 0, height // 2 - 1)).astype(int)
    nearest = np.full((height // 2, width // 2), np.inf)
    np.minimum.at(nearest, (row, column), depth)
    facing = np.abs(normal @ view.forward)
    return inside & (facing > 0.5) & (depth < nearest[row, column] + 4 / view.scale / facing)


def sample(image, x, y):
    """Bilinear."""
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    u, v = x - i, y - j
    return ((image[j, i] * (1 - u) + image[j, i + 1] * u) * (1 - v)
            + (image[j + 1, i] * (1 - u) + image[j + 1, i + 1] * u) * v)


def blur(image, spread=SPREAD):
    reach = int(3 * spread)
    weight = np.exp(-np.arange(-reach, reach + 1) ** 2 / (2 * spread ** 2))
    for axis in (0, 1):
        image = np.apply_along_axis(lambda line: np.convolve(line, weight / weight.sum(), "same"), axis, image)
    return image


def angles(texture, view, place, vectors):
    """Degrees between the streaks and the projected flow."""
    gy, gx = np.gradient(texture)
    x, y, _ = view.place(place)
    xx, xy, yy = (sample(blur(g), x, y) for g in (gx * gx, gx * gy, gy * gy))
    across = 0.5 * np.arctan2(2 * xy, xx - yy)
    dx, dy = view.direction(vectors)
    return np.degrees(np.arcsin(np.clip(np.abs(np.cos(across) * dx + np.sin(across) * dy) / np.hypot(dx, dy), 0, 1)))


def main(surface, cameras, folder, name):
    points, triangles, vectors = read_vtp.read(surface)
    place, normal, flow = draw_points(points, triangles, vectors, 2000000, 1)
    textures, views, visible = [], [], np.ones(len(place), bool)
    for k, camera in enumerate(json.load(open(cameras))[:2]):
        plain = brightness(f"{folder}/{name}-{k}-plain.png")
        texture = brightness(f"{folder}/{name}-{k}.png") / np.maximum(plain, 1)
        textures.append(texture - blur(texture, 10))  # what is left of the light is no texture
        views.append(View(camera, plain.shape))
        visible &= seen(views[k], place, normal)
    chosen = np.flatnonzero(visible)[:60000]
    values = [sample(t, *v.place(place[chosen])[:2]) for t, v in zip(textures, views)]
    deviation = np.abs(values[0] - values[0].mean()).mean()
    print("points", len(chosen))
    print("difference", np.abs(values[0] - values[1]).mean() / deviation)
    print("correlation", np.corrcoef(*values)[0, 1])
    speed = np.linalg.norm(flow[chosen], axis=1)
    facing = np.abs(normal[chosen] @ views[0].forward) > 0.7
    fast = chosen[facing & (speed > 0.2 * np.percentile(speed, 98))]
    print("angle", np.median(angles(textures[0], views[0], place[fast], flow[fast])))


if len(sys.argv) != 5:
    sys.exit(__doc__)
main(*sys.argv[1:])
