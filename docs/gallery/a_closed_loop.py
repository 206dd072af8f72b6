"""
A closed loop
=============

A finger, a ball on springs, pushes a block to a goal at 30 mm. The finger's target lies inside the
block, and the deeper, the farther the block is from the goal.

Such a proportional controller stops short of the goal, where the force that it commands equals the
friction, K_q 0.2 (goal - x) = mu_v m g.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

goal, K_q, mu_v, m = 0.03, 1000.0, 0.3, 0.5
finger = qr.Body.of_shape(
    "finger", qr.Sphere(0.01), mass=0.1, xyz=(-0.06, 0, 0.02), actuated=["base"]
)
block = qr.Body.of_shape("block", qr.Box((0.05, 0.05, 0.02)), mass=m, xyz=(0, 0, 0.02))
scenario = qr.load_scenario({
    "h": 0.05,
    "steps": 60,
    "bodies": {
        "finger": {"body": finger, "K_q": {"base": [K_q, K_q, K_q, 10, 10, 10]}},
        "block": block,
    },
    "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
    "contacts": {
        "floor": {"alpha": "floor", "beta": "block", "mu_v": mu_v, "rows": 4, "k": 4},
        "push": {"alpha": "finger", "beta": "block", "mu_v": 0.0, "rows": 4},
    },
})  # fmt: skip
system = scenario.system


def towards(t, q):
    """The finger's target at a configuration q."""
    x = system.of(q, "block.x")
    return {"finger.x": x - 0.06 + 0.2 * (goal - x)}


run = qr.rollout(scenario.simulator(), system.q_start, towards, steps=60, progress=False)
x = system.of(run.q, "block.x")
expected = goal - mu_v * m * 9.81 / (0.2 * K_q)
assert abs(x[-1] - expected) < 1e-5

figure, (scene, curve) = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
qr.draw_scene(scene, qr.figures.moment(scenario, run, -1))
curve.plot(np.append(0, run.t), 1e3 * x, color="black", label=f"ends at {1e3 * x[-1]:.2f} mm")
curve.axhline(1e3 * expected, color="0.6", linewidth=3, zorder=0, label="expected end")
curve.axhline(1e3 * goal, color="black", linestyle=":", label="goal")
curve.set(xlabel="time t [s]", ylabel="x [mm]")
curve.set_title("It stops short of its goal")
curve.legend()
plt.show()
