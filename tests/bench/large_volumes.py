#!/usr/bin/env python3
"""Makes label volumes that are large beside their surfaces, meshes each, prints stages, time and memory.

large_volumes.py PROGRAM [CASE...] [--folder DIR] [--keep] [--options "..."]

Volumes are written layer by layer (MetaImage, or NRRD in one file), so that none is ever held whole.
"""

import argparse
import json
import math
import os
import random
import shlex
import subprocess
import sys
import tempfile
import time

ORGANS = 60


def direction(numbers):
    """A direction, evenly distributed."""
    v = [numbers.gauss(0, 1) for _ in range(3)]
    length = math.hypot(*v)
    return [x / length for x in v]


def organs(dims):
    """A body with 59 organs: centres, half axes, labels; later ones lie over earlier ones."""
    numbers = random.Random(7)
    shapes = [([n / 2 for n in dims], [n * 0.46 for n in dims], 1)]
    for label in range(2, ORGANS + 1):
        half = [min(dims) * numbers.uniform(0.05, 0.14) for _ in dims]
        away = numbers.random() ** (1 / 3)
        centre = [n / 2 + away * d * (n * 0.44 - h) for n, d, h in zip(dims, direction(numbers), half)]
        shapes.append((centre, half, label))
    return shapes


def shell(centre, radius, thickness, label):
    """A thin shell: a ball, and what is inside of it."""
    return [(centre, [radius] * 3, label), (centre, [radius - thickness] * 3, 0)]


def shells(dims):
    """A few thin shells."""
    found = []
    for label, (where, radius) in enumerate([(0.3, 0.22), (0.55, 0.17), (0.75, 0.2)], 1):
        found += shell([dims[0] / 2, dims[1] / 2, dims[2] * where], min(dims) * radius, 4, label)
    return found


def balls_and_shells(dims):
    """Some balls, and shells around some of them."""
    numbers = random.Random(3)
    found = []
    for label in range(1, 13):
        radius = min(dims) * numbers.uniform(0.02, 0.06)
        centre = [n * numbers.uniform(0.1, 0.9) for n in dims]
        if label % 3 == 0:
            found += shell(centre, radius + 14, 5, 20 + label)
        found.append((centre, [radius] * 3, label))
    return found


CASES = {
    "organs": ((512, 512, 1024), organs, "--min-size 2 --max-size 3"),
    "shells": ((1100, 1100, 2048), shells, "--min-size 3 --max-size 5"),
    "balls": ((2048, 2048, 2000), balls_and_shells, "--min-size 2 --max-size 3"),
    "small": ((96, 80, 150), organs, "--min-size 1 --max-size 2"),
}


def span(centre, half, rest, size):
    """The voxels within half axis times the root of `rest`."""
    reach = half * math.sqrt(rest)
    return max(0, math.ceil(centre - reach)), min(size, math.floor(centre + reach) + 1)


def layer(dims, shapes, z):
    """Labels of one layer of voxels."""
    labels = bytearray(dims[0] * dims[1])
    for centre, half, label in shapes:
        rest = 1 - ((z - centre[2]) / half[2]) ** 2
        if rest <= 0:
            continue
        for y in range(*span(centre[1], half[1], rest, dims[1])):
            left = rest - ((y - centre[1]) / half[1]) ** 2
            low, high = span(centre[0], half[0], max(left, 0), dims[0])
            if low < high:
                labels[y * dims[0] + low:y * dims[0] + high] = bytes([label]) * (high - low)
    return labels


def write_volume(file, dims, shapes):
    """NRRD or MetaImage, by the extension; the values follow the header."""
    sizes = " ".join(str(n) for n in dims)
    if file.endswith(".nrrd"):
        header = (f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {sizes}\nspacings: 1 1 1\nencoding: raw\n\n")
    else:
        header = (f"ObjectType = Image\nNDims = 3\nDimSize = {sizes}\nElementSpacing = 1 1 1\nOffset = 0 0 0\n"
                  "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n")
    with open(file, "wb") as out:
        out.write(header.encode())
        for z in range(dims[2]):
            out.write(layer(dims, shapes, z))


def run(program, volume, options, folder):
    """Meshes a volume; returns the report, and seconds and peak memory of the process as the system counts them."""
    report = os.path.join(folder, "report.json")
    command = [program, "mesh", volume, *shlex.split(options), "--report", report, "--out",
               os.path.join(folder, "mesh.ply"), "--quiet"]
    begun = time.time()
    with subprocess.Popen(command) as child:
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    seconds = time.time() - begun
    if child.returncode != 0:
        return None, seconds, usage.ru_maxrss * 1024 / 1e9
    with open(report, encoding="utf-8") as text:
        return json.load(text), seconds, usage.ru_maxrss * 1024 / 1e9


def show(case, dims, report, seconds, memory):
    """One row of a table."""
    head = f"{case} {'x'.join(map(str, dims))}: {seconds:.1f} s, peak {memory:.2f} GB"
    if report is None:
        print(head, "- failed", flush=True)
        return
    stages = {stage["name"]: stage["seconds"] for stage in report["stages"]}
    print(head, f"- {report['mesh']['triangles']} triangles, sound: {report['mesh']['sound']}")
    print("  ", ", ".join(f"{name} {value:.1f}" for name, value in stages.items()), flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("program")
    options.add_argument("cases", nargs="*", default=["organs"], help="of " + ", ".join(CASES))
    options.add_argument("--folder", help="for the volumes; the largest takes 8.4 GB")
    options.add_argument("--format", choices=["nrrd", "mha"], default="nrrd")
    options.add_argument("--keep", action="store_true", help="leave the volumes there")
    options.add_argument("--options", help="of nacre mesh, instead of the case's own")
    chosen = options.parse_args()
    failed = False
    if unknown := set(chosen.cases) - set(CASES):
        options.error(f"no case {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory(dir=chosen.folder) as folder:
        for case in chosen.cases:
            dims, shapes, own = CASES[case]
            file = os.path.join(chosen.folder or folder, f"{case}.{chosen.format}")
            if not os.path.exists(file):
                write_volume(file, dims, shapes(dims))
            report, seconds, memory = run(chosen.program, file, chosen.options or own, folder)
            show(case, dims, report, seconds, memory)
            failed = failed or report is None
            if not chosen.keep:
                os.remove(file)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
