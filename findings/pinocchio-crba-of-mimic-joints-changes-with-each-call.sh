#!/usr/bin/env bash
# pinocchio 4.1.0: a chain of two hinges, whose second mimics the first, carries two more hinges on its last link. Its mass
# matrix comes from crba, called three times at the same configuration with the same data.
# Expected: the same matrix each time, that of the model without mimic joints, reduced by the coupling.
# What comes: the entries that couple the two last hinges to the first grow from call to call, and one of them is wrong in
# the first call already.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin

INERTIAL = (
    '<inertial><origin xyz="0.1 0 0"/><mass value="1"/>'
    '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>'
)
PARENTS = {"a": "base", "b": "a", "c": "b", "d": "b"}
links = "".join(f'<link name="{name}">{INERTIAL}</link>' for name in ("base", *PARENTS))
joints = ""
for child, parent in PARENTS.items():
    mimic = '<mimic joint="a" multiplier="1"/>' if child == "b" else ""
    joints += (
        f'<joint name="{child}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>{mimic}</joint>'
    )
text = f'<robot name="fork">{links}{joints}</robot>'
model = pin.buildModelFromXML(text, mimic=True)
data = model.createData()
rows = [pin.crba(model, data, np.zeros(3))[0].copy() for _ in range(3)]
free = pin.buildModelFromXML(text)
coupling = np.array([[1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
right = coupling.T @ pin.crba(free, free.createData(), np.zeros(4)) @ coupling
for k, row in enumerate(rows):
    print(f"first row in call {k + 1}:", row.round(6))
print("first row, right:   ", right[0].round(6))
assert not np.allclose(rows[0], rows[1])
assert not np.allclose(rows[1], rows[2])
assert not np.allclose(rows[0], right[0])
PYTHON
