#!/usr/bin/env bash
# pyvista 0.49.1: the volume of bounding_box() and of oriented_bounding_box() around a block of 3 x 2 x 1 m, straight or turned, at the
# origin and 1 and 10 m beside it, as the six faces that come by default, and merged (as_composite=False).
# Expected: 6 m^3, or none, since six single faces enclose nothing; their area is 22 m^2. What comes for the faces: 18 m^3
# around the straight block and 13.8 m^3 around the turned one, and 52 and 44 m^3 once the block lies 10 m away, since a volume is
# computed for each open face and added up. Merged, the box has 6 m^3 everywhere.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
import pyvista

MADE = {0: (18.0, 13.8), 1: (18.0, 13.8), 10: (52.0, 43.9)}
for away, volumes in MADE.items():
    straight = pyvista.Cube(x_length=3, y_length=2, z_length=1)
    turned = straight.rotate_z(30).rotate_x(20).translate((away, 0, 0))
    straight = straight.translate((away, 0, 0))
    cases = (("straight", straight.bounding_box), ("turned", turned.oriented_bounding_box))
    for (name, box), volume in zip(cases, volumes, strict=True):
        faces, merged = box(), box(as_composite=False)
        area = sum(face.area for face in faces)
        print(f"{name}, {away} m away: faces of {area:.2f} m^2 with {faces.volume:.2f} m^3, merged {merged.volume:.2f} m^3, due 6 m^3")
        assert np.isclose(area, 22.0, atol=1e-4)
        assert np.isclose(merged.volume, 6.0, atol=1e-4)
        assert np.isclose(faces.volume, volume, atol=0.1)
PYTHON
