#!/usr/bin/env bash
# MuJoCo 4.0.0: trees of spheres fall on a plane, with elliptic cones. In the same states mj_forward is called twice, with
# a sparse and with a dense Jacobian, which the documentation calls two ways to compute the same.
# Expected: equal accelerations but for rounding. What comes: in more than a quarter of the states they differ, by up to more
# than the largest acceleration.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet mujoco==4.0.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import mujoco
import numpy as np

DENSE, SPARSE = 0, 1
rng = np.random.default_rng(0)
differences = []
for _ in range(30):
    trees = ["", "", ""]
    for x, y, z in rng.uniform(-0.15, 0.15, (5, 3)):
        trees = [
            f'<body pos="{x} {y} {z}"><joint axis="{x} {y} 1"/><geom size=".06"/>{tree}'
            f'<body pos="{y} {z} {x}"><joint axis="{z} 1 {x}"/><geom size=".06"/></body></body>'
            for tree in trees
        ]
    bodies = "".join(
        f'<body pos="{0.2 * k} 0 .2"><freejoint/><geom size=".06"/>{tree}'
        f'{tree.replace(".06", ".05")}</body>'
        for k, tree in enumerate(trees)
    )
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option cone="elliptic" jacobian="dense"/><worldbody>'
        f'<geom type="plane" size="3 3 1"/>{bodies}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    for _ in range(6):
        mujoco.mj_step(model, data, 10)
        accelerations = {}
        for jacobian in (SPARSE, DENSE):
            model.opt.jacobian = jacobian
            mujoco.mj_forward(model, data)
            accelerations[jacobian] = data.qacc.copy()
        largest = np.abs(accelerations[DENSE]).max()
        differences.append(np.abs(accelerations[SPARSE] - accelerations[DENSE]).max() / largest)
many = sum(difference > 1e-6 for difference in differences)
print(f"MuJoCo {mujoco.__version__}: {many} of {len(differences)} states differ,")
print(f"by at most {max(differences):.2g} of the largest acceleration")
assert many > 10
assert max(differences) > 0.1
PYTHON
