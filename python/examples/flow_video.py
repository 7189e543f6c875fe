# Nacre: unsteady flow on a surface to a video.
"""A velocity that is a function of time, on a torus, to a video (or GIF) of 24 frames.

Usage: python flow_video.py FLOW.mp4   (pip install nacre-mesh imageio imageio-ffmpeg)
In Jupyter, IPython.display.Video("FLOW.mp4") shows it inline.
"""

# %% A torus.
import sys

import imageio.v3
import numpy as np

import nacre

n, m = 96, 48
u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
ring = 2 + 0.8 * np.cos(v)
points = np.stack([ring * np.cos(u), ring * np.sin(u), 0.8 * np.sin(v)], axis=-1).reshape(-1, 3)
i, j = (k.ravel() for k in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
right, up = (i + 1) % n, (j + 1) % m
quads = np.stack([i * m + j, right * m + j, right * m + up, i * m + up], axis=-1)
triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


# %% Flow around the axis, and a current through the hole that turns round.
def velocity(time):
    around = np.stack([-points[:, 1], points[:, 0], np.zeros(len(points))], axis=-1)
    through = np.array([0, 0, 2.0]) * np.cos(2 * np.pi * time)
    return around + through


# %% Frame by frame. A knob may change on the way.
flow = nacre.flow(
    points, triangles, velocity, times=np.linspace(0, 1, 21), steps=24, resolution=224, width=400, height=304, orbit=1.5
)
frames = []
for frame in flow:
    frames.append(frame.image[..., :3])
    if frame.index == 12:
        flow.colormap = "ember"

# %% The video.
imageio.v3.imwrite(sys.argv[1], np.stack(frames), fps=25)
change = np.mean([np.abs(np.subtract(a, b, dtype=float)).mean() for a, b in zip(frames, frames[1:])])
print(f"{len(frames)} frames, {change:.1f} grey levels from frame to frame")
