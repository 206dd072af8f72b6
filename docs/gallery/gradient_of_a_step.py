"""
The gradient of a step
======================

A finger, a ball on springs, pushes a free ball from a little aside. By how much does the end of the
free ball change with the side on which the finger stands?

The derivative of the step answers without a second step; a finite difference agrees.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

radius, finger, gap, ahead = 0.03, 0.02, 1e-4, 0.006
x = -(radius + finger + gap)


def scene(side):
    """A simulator and its start, with the finger at (x, side) [m]."""
    scenario = qr.load_scenario({
        "h": 0.01, "steps": 1, "gravity": [0, 0, 0],
        "bodies": {
            "finger": {
                "body": qr.Body.of_shape("finger", qr.Sphere(finger), mass=0.1, xyz=(x, side, 0),
                                         actuated=["base"]),
                "K_q": {"base": [1000, 1000, 1000, 10, 10, 10]},
            },
            "ball": qr.Body.of_shape("ball", qr.Sphere(radius), mass=0.5),
        },
        "contacts": {"push": {"alpha": "finger", "beta": "ball", "mu_v": 0.3, "rows": 4}},
    })  # fmt: skip
    return scenario.simulator(), scenario.system.q_start


def target(q):
    """Where the finger is to go: straight ahead."""
    return q[:7] + ahead * np.eye(7)[0]


def end(side):
    """Where the ball is after the step, y [m]."""
    simulator, q = scene(side)
    return simulator.step(q, target(q)).q[8]


# %%
# The finger's start and its target move aside together: two columns of the derivative.
side = 0.004
simulator, q = scene(side)
found = qr.derivatives(simulator, q, target(q))
column = found.dq_dq[6:9, 1] + found.dq_dq_bar_a[6:9, 1]
R, _ = simulator.system.pose(found.result.q, "ball")
slope = (R @ column)[1]  # from the ball's own axes to the world's
difference = (end(side + 1e-6) - end(side - 1e-6)) / 2e-6
assert abs(slope - difference) < 1e-6

figure, axes = plt.subplots(figsize=(4.8, 3.2), layout="constrained")
sides = np.linspace(-0.014, 0.014, 15)
axes.plot(1e3 * sides, [1e3 * end(one) for one in sides], "k.", label="steps")
reach = np.array([-0.006, 0.006])
tangent = end(side) + slope * reach
axes.plot(1e3 * (side + reach), 1e3 * tangent, label=f"derivative: {slope:.4f}")
point = {"fillstyle": "none", "markersize": 9, "label": "its point"}
axes.plot(1e3 * side, 1e3 * end(side), "ko", **point)
axes.set_title("The derivative is their slope")
axes.set(xlabel="y of the finger [mm]", ylabel="y of the ball after the step [mm]")
axes.legend()
plt.show()
