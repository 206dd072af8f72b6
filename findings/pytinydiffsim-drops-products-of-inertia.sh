#!/usr/bin/env bash
# pytinydiffsim 0.9.5: a rod that lies halfway between x and y of its link, once as a diagonal inertia in a turned frame, once
# as a full inertia with its product ixy in the link's frame. Both are one body.
# Expected: turned about its own line, either has the 0.02 kg m^2 of a thin rod; across it, either has 1 kg m^2.
# What comes: the full inertia has 0.51 kg m^2 about both lines, for ixy is left out. The turned frame turns backwards, so that
# the rod lies across: 1 kg m^2 about its own line. No way of writing gives the rod.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pytinydiffsim==0.9.5 numpy==2.4.6
cd "$folder"

venv/bin/python - << 'PYTHON'
import math

import pytinydiffsim as tds

ALONG, ACROSS = 0.02, 1.0  # kg m^2
HALF, PRODUCT = (ALONG + ACROSS) / 2, (ALONG - ACROSS) / 2
s = math.sqrt(0.5)
ROD = {
    "turned frame": (math.pi / 4, f'ixx="{ALONG}" iyy="{ACROSS}" izz="{ACROSS}" ixy="0" ixz="0" iyz="0"'),
    "product": (0.0, f'ixx="{HALF}" iyy="{HALF}" izz="{ACROSS}" ixy="{PRODUCT}" ixz="0" iyz="0"'),
}
LINES = {"along the rod": (f"{s} {s} 0", ALONG), "across it": (f"{s} {-s} 0", ACROSS)}

for form, (yaw, inertia) in ROD.items():
    for line, (axis, true) in LINES.items():
        with open("rod.urdf", "w", encoding="ascii") as file:
            file.write(
                '<robot name="r"><link name="base"/><joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/>'
                f'<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="{axis}"/><limit lower="-2" upper="2" effort="9" velocity="9"/>'
                f'</joint><link name="rod"><inertial><origin xyz="0 0 0" rpy="0 0 {yaw}"/><mass value="1"/><inertia {inertia}/>'
                "</inertial></link></robot>"
            )
        body = tds.TinyMultiBody(False)
        tds.UrdfToMultiBody2().convert2(tds.TinyUrdfParser().load_urdf("rod.urdf", False), tds.TinyWorld(), body)
        q, M = tds.VectorX(1), tds.Matrix(1, 1)
        q[0] = 0.0
        tds.mass_matrix(body, q, M)
        print(f"{form}, {line}: {M[0, 0]:.3f} kg m^2, true {true}")
        seen = HALF if form == "product" else ALONG + ACROSS - true
        assert abs(M[0, 0] - seen) < 1e-6
PYTHON
