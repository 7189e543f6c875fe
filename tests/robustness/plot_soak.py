#!/usr/bin/env python3
"""Nacre: draws what soak.sh writes down as an SVG. Usage: plot_soak.py SOAK.csv TITLE > PLOT.svg

The memory of the process over time; a column of a pixel holds all samples of its time, from the least to the most.
"""
import csv
import sys

WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 720, 240, 60, 30, 15, 40


def main(file, title):
    with open(file, newline="") as lines:
        samples = [(float(seconds), float(kib) / 1024) for seconds, kib, _ in csv.reader(lines)]
    last, most = samples[-1][0], max(mib for _, mib in samples)
    step = next(s for s in (1, 2, 5, 10, 20, 50, 100, 200, 500) if most * 1.2 <= 6 * s)
    top = step * int(most * 1.2 / step + 1)
    x = lambda seconds: LEFT + (WIDTH - LEFT - RIGHT) * seconds / last
    y = lambda mib: HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * mib / top
    columns = {}
    for seconds, mib in samples:
        low, high = columns.get(int(x(seconds)), (mib, mib))
        columns[int(x(seconds))] = (min(low, mib), max(high, mib))

    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif"'
          ' font-size="12">\n<rect width="100%" height="100%" fill="white"/>')
    print(f'<text x="{LEFT}" y="18">{title}</text>')
    for mib in range(0, top + 1, step):
        print(f'<path d="M{LEFT} {y(mib):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
              f'<text x="{LEFT - 6}" y="{y(mib) + 4:.1f}" text-anchor="end">{mib}</text>')
    print(f'<text x="{LEFT - 6}" y="{TOP - 12}" text-anchor="end">MiB</text>')
    minutes = last / 60
    tick = next(t for t in (1, 2, 5, 10, 20, 30, 60, 120, 240) if minutes <= 8 * t or t == 240)
    for minute in range(0, int(minutes) + 1, tick):
        print(f'<text x="{x(60 * minute):.1f}" y="{HEIGHT - 18}" text-anchor="middle">{minute}</text>')
    print(f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 4}" text-anchor="end">minutes</text>')
    path = "".join(f"M{column} {y(low) + 0.5:.1f}V{y(high) - 0.5:.1f}" for column, (low, high) in columns.items())
    print(f'<path d="{path}" stroke="#1f5fa8"/>\n</svg>')


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
