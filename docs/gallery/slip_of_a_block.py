"""
Slip of a block that is pulled
==============================

A force F pulls a block sideways, which rests on one contact: the smallest step with friction.

To slide by x, the block has to rise by mu_v x: Eqs. (5) and (6) ask for a gap of ``mu_v |x|``.
The rise takes work against the weight, so nothing moves until F exceeds mu_v m g. A larger F moves
the block in a step by h^2 (F - mu_v m g) / (m (1 + mu_v^2)).
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

# %%
# The step: delta_q is the displacement (x, y, z) of a point mass that touches the floor.
m, mu_v, h, gravity = 0.5, 0.4, 0.01, 9.81
J = np.vstack([np.eye(3), np.zeros((1, 3))])  # velocities along x, y, z, and the spin, which is 0
floor = qr.Contacts(
    name=("floor/block",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]], J=[J],
    mu_v=[mu_v], mu_omega=[0.0], rows=[4],
)  # fmt: skip


def slip(pull):
    """How far a pull [N] moves the block along x in one step [m]."""
    step = qr.StepData(
        h=h, K_q=[], M_u=m * np.eye(3), tau_a=[], tau_u=[pull, 0, -m * gravity],
        delta_q_bar_a=[], contacts=floor,
    )  # fmt: skip
    return qr.solve_step(step).delta_q[0]


# %%
# It sticks below the threshold, exactly, and slides by the formula beyond it.
limit = mu_v * m * gravity
pulls = limit * np.linspace(0, 2, 21)
slips = np.array([slip(pull) for pull in pulls])
formula = h**2 * np.maximum(pulls - limit, 0) / (m * (1 + mu_v**2))
assert slip(0.99 * limit) == 0
assert np.abs(slips - formula).max() < 1e-15

figure, axes = plt.subplots(figsize=(4.5, 3.2), layout="constrained")
axes.plot(pulls / limit, 1e3 * formula, color="0.6", linewidth=3, label="closed form")
axes.plot(pulls / limit, 1e3 * slips, "ko", markersize=4, label="steps")
axes.set(xlabel=r"pull / ($\mu_v m g$) [-]", ylabel="slip in one step [mm]")
axes.set_title("Up to the limit the block sticks")
axes.legend()
plt.show()
