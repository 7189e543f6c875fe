# Nacre: writes python/nacre/_knobs.py, the knobs as types, from the table of an installed nacre.
"""Usage: python python/tools/make_knobs.py > python/nacre/_knobs.py"""

import nacre

TEXTS = {
    "isovalue": "str | float | Sequence[float]",
    "threshold": "str | tuple[float, float]",
    "materials": "str | int | Sequence[int]",
    "merge": "str | Mapping[int, int]",
    "time": "str | tuple[float, float]",
    "color_range": "str | tuple[float, float]",
}


def type_of(knob: nacre.Knob) -> str:
    if knob.choices:
        return "Literal[" + ", ".join(f'"{c}"' for c in knob.choices) + "]"
    return TEXTS.get(knob.name, type(knob.default).__name__)


def main() -> None:
    print("# Nacre: the knobs as types. Made by python/tools/make_knobs.py; not edited by hand.")
    print('"""The knobs of `nacre.mesh` and `nacre.flow` as types."""\n')
    print("from __future__ import annotations\n")
    print("from collections.abc import Mapping, Sequence")
    print("from typing import Literal, TypedDict\n")
    for title, job in (("MeshKnobs", "mesh"), ("FlowKnobs", "flow")):
        print(f"\nclass {title}(TypedDict, total=False):")
        print(f'    """Knobs of `nacre.{job}`."""\n')
        for knob in nacre.knobs(job):
            print(f"    {knob.name}: {type_of(knob)}  #: {knob.help}" + (f" [{knob.unit}]" if knob.unit else ""))


if __name__ == "__main__":
    main()
