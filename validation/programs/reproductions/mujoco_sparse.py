"""Accelerations with a sparse and with a dense Jacobian, in the same states of falling trees of bodies."""

import mujoco
import numpy as np

rng = np.random.default_rng(0)
found = []
for _ in range(30):
    trees = ["", "", ""]
    for x, y, z in rng.uniform(-0.15, 0.15, (5, 3)):
        trees = [f'<body pos="{x} {y} {z}"><joint axis="{x} {y} 1"/><geom size=".06"/>{t}<body pos="{y} {z} {x}"><joint axis="{z} 1 {x}"/><geom size=".06"/></body></body>' for t in trees]
    world = "".join(f'<body pos="{0.2 * k} 0 .2"><freejoint/><geom size=".06"/>{tree}{tree.replace(".06", ".05")}</body>' for k, tree in enumerate(trees))
    data = mujoco.MjData(model := mujoco.MjModel.from_xml_string(f'<mujoco><option cone="elliptic" jacobian="dense"/><worldbody><geom type="plane" size="3 3 1"/>{world}</worldbody></mujoco>'))
    for _ in range(6):
        mujoco.mj_step(model, data, 10)
        for model.opt.jacobian in 1, 0:  # sparse, dense
            found.append(mujoco.mj_forward(model, data) or data.qacc.copy())
differ = [np.abs(a - b).max() / np.abs(b).max() for a, b in zip(found[::2], found[1::2], strict=True)]
print(f"MuJoCo {mujoco.__version__}: {sum(x > 1e-9 for x in differ)} of {len(differ)} differ, by {max(differ):.2g} of the largest at most")
