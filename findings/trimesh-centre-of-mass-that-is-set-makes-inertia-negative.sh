#!/usr/bin/env bash
# trimesh 5.2.0: a cuboid of 1 x 2 x 3 m and 12 kg, whose center_mass is set ("override the point in space which is the center of
# mass") by 0 to 0.5 m beside its middle; then the same cuboid moved away by 0 to 2 m.
# Expected: moments of inertia about that point by Steiner's theorem, 13, 10 + 12 d^2 and 5 + 12 d^2 kg m^2, or those about the
# middle; and the same after a move. What comes: they shrink with d by as much as they should grow, and further with each move,
# so that a move of 2 m makes a moment of -22 kg m^2, in mass_properties too; nothing warns.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet trimesh==5.2.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import trimesh

MASS = 12.0
for d in (0.0, 0.1, 0.2, 0.5):
    for move in (0.0, 1.0, 2.0):
        cuboid = trimesh.creation.box((1, 2, 3))
        cuboid.density = 2.0
        cuboid.center_mass = (d, 0.0, 0.0)
        cuboid.apply_translation((move, 0.0, 0.0))
        moments = np.diag(cuboid.moment_inertia)
        print(f"set {d} m beside the middle, moved by {move} m: centre of mass at {cuboid.center_mass[0]:.1f} m,", end=" ")
        print(f"moments {moments.round(2)}, by Steiner {np.round([13, 10 + MASS * d**2, 5 + MASS * d**2], 2)}")
        shrunk = MASS * ((move + d) ** 2 - move**2)
        assert np.allclose(moments, [13, 10 - shrunk, 5 - shrunk])
        assert np.allclose(cuboid.mass_properties.inertia, np.diag(moments))
        assert np.allclose(cuboid.center_mass, (move + d, 0, 0)) and np.isclose(cuboid.mass, MASS)
PYTHON
