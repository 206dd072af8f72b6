"""
A displacement of a body is a screw
===================================

A free body's delta_q is a twist in the body's own frame: a motion along its axes and a turn about
them. The body moves and turns at the same time, q exp6(delta_q), so "ahead" turns with the body.

After d ahead and a turn theta about z the body is at x = d sin(theta) / theta and
y = d (1 - cos(theta)) / theta.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

body = qr.Body.of_shape("body", qr.Box((0.01, 0.006, 0.005)), mass=0.1)
system = qr.System([body])
ahead, turn = 0.1, np.radians(120)
twist = np.array([ahead, 0, 0, 0, 0, turn])


def pose(share):
    """Rotation (3, 3) and place (3,) [m] after a share of the twist."""
    return system.pose(system.integrate(system.q_start, share * twist), "body")


_, end = pose(1.0)
formula = ahead * np.array([np.sin(turn), 1 - np.cos(turn), 0]) / turn
assert np.abs(end - formula).max() < 1e-15

figure, axes = plt.subplots(figsize=(5.4, 3.8), layout="constrained")
path = np.array([pose(share)[1] for share in np.linspace(0, 1, 60)])
axes.plot(*1e3 * path[:, :2].T, color="black", label="path")
outline = np.array([[-1, -1, 0], [1, -1, 0], [1.6, 0, 0], [1, 1, 0], [-1, 1, 0]]) * 0.008
for share in np.linspace(0, 1, 6):
    R, t = pose(share)
    axes.fill(
        *1e3 * (outline @ R.T + t)[:, :2].T, facecolor="0.85", edgecolor="black", linestyle="-"
    )
turned = 1e3 * (outline @ R.T + [ahead, 0, 0])[:, :2].T
axes.fill(*turned, fill=False, linestyle=":", label="straight, then turned")
axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
axes.set_title(f"An arc, to ({1e3 * end[0]:.1f}, {1e3 * end[1]:.1f}) mm")
figure.legend(loc="outside lower center", ncols=2)
plt.show()
