"""Nacre: gives an OpenFOAM case two time steps with a wall shear stress on its patches. Usage: add_steps.py CASE"""

import pathlib
import sys

import Ofpp

HEAD = """FoamFile
{{
    version     2.0;
    format      ascii;
    class       volVectorField;
    location    "{time}";
    object      wallShearStress;
}}

dimensions      [0 2 -2 0 0 0 0];
internalField   uniform (0 0 0);
boundaryField
{{
"""

if __name__ == "__main__":
    case = pathlib.Path(sys.argv[1])
    mesh = Ofpp.FoamMesh(str(case))
    for time in (0.5, 1.5):
        text = HEAD.format(time=time)
        for name, patch in mesh.boundary.items():
            values = f"({time} 0 0)\n" * patch.num
            text += (f"    {name.decode()}\n    {{\n        type calculated;\n"
                     f"        value nonuniform List<vector>\n{patch.num}\n(\n{values});\n    }}\n")
        (case / str(time)).mkdir()
        (case / str(time) / "wallShearStress").write_text(text + "}\n")
