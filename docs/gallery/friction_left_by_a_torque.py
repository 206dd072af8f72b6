"""
What a torque leaves of friction
================================

The rows of a contact share one normal force. In the paper's pyramid, a torque that uses 60 % of
what torsional friction can bear leaves 40 % of the friction along the floor. In the ellipsoid it
leaves 80 %, and in the product of both limits all.

A push just below what a cone leaves does not move the body, and a push just above it does.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

# %%
# A body on one contact that can bear torque: delta_q is (x, y, z, turn about z).
m, inertia, mu_v, mu_omega, gravity = 0.5, 1e-4, 0.4, 0.02, 9.81
floor = qr.Contacts(
    name=("floor/body",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]], J=[np.eye(4)],
    mu_v=[mu_v], mu_omega=[mu_omega], rows=[6],
)  # fmt: skip
share = 0.6
torque = share * mu_omega * m * gravity
left = {"pyramid": 1 - share, "ellipsoid": np.sqrt(1 - share**2), "product": 1.0}


def motion(push, cone):
    """Largest entry of delta_q [m, rad] under a push [N] and the torque."""
    step = qr.StepData(
        h=0.01, K_q=[], M_u=np.diag([m, m, m, inertia]), tau_a=[],
        tau_u=[push, 0, -m * gravity, torque], delta_q_bar_a=[], contacts=floor, cone=cone,
    )  # fmt: skip
    return np.abs(qr.solve_step(step).delta_q).max()


# %%
# Each cone, cut at this normal force, with a push that is just borne.
figure, panels = plt.subplots(1, 3, figsize=(8.5, 3.6), layout="constrained")
for axes, (cone, friction) in zip(panels, left.items(), strict=True):
    limit = friction * mu_v * m * gravity
    assert motion(0.97 * limit, cone) < 1e-12
    assert motion(1.03 * limit, cone) > 1e-6
    corners = 200 if cone == "ellipsoid" else 4
    angle = np.linspace(0, 2 * np.pi, corners + 1)
    edge = mu_v * m * gravity * np.array([np.cos(angle), np.sin(angle)])
    axes.plot(*edge, "--", color="black", label="without a torque")
    axes.fill(*(friction * edge), color="0.8", label="with it")
    axes.plot([0, 0.97 * limit], [0, 0], color="tab:red", label="the push")
    axes.set(aspect="equal", xlabel="$f_{d_1}$ [N]", ylabel="$f_{d_2}$ [N]")
    axes.set_title(f"{cone}: {friction:.0%} left")
figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
plt.show()
