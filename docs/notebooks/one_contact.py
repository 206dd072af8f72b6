# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # One contact
#
# A block of 1 kg lies on a table. Its displacement in a step is (dx, dy, dz, dtheta), and J of its contact is the identity. This notebook shows its friction cone, when it sticks and when it slips, and its multipliers. It needs neither pinocchio nor a URDF.

# %%
import matplotlib.pyplot as plt
import numpy as np
from ipywidgets import FloatSlider, interact

import quasistatic_ref as qr

GRAVITY, H = 9.81, 0.01


def block(push, mu_v=0.5, mu_omega=0.02, torque=0.0):
    """A block of 1 kg on one contact, that a force [N] along x and a torque [N m] push."""
    contact = qr.Contacts(
        name=("table/block",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]],
        J=[np.eye(4)], mu_v=[mu_v], mu_omega=[mu_omega], rows=[6],
    )  # fmt: skip
    M_u = np.diag([1.0, 1.0, 1.0, 1e-3])
    tau_u = [push, 0.0, -GRAVITY, torque]
    return qr.StepData(h=H, K_q=[], M_u=M_u, tau_a=[], tau_u=tau_u,
                       delta_q_bar_a=[], contacts=contact)  # fmt: skip


# %% [markdown]
# ## The cone, and a load in it
#
# The six rows of a contact share one normal force: |f_1| / mu_v + |f_2| / mu_v + |tau_n| / mu_omega <= f_n. Move mu_v, the push and the torque. The point is the friction; on the edge of the area the block slides. A torque about the normal uses up a part of the normal force, so the area shrinks.


# %%
def draw_cone(axes, wrench, mu_v, mu_omega=0.02):
    """The section |f_1| + |f_2| <= mu_v (f_n - |tau_n| / mu_omega), and the friction in it."""
    f_1, f_2, f_n, tau_n = wrench
    bound = mu_v * (f_n - abs(tau_n) / mu_omega)
    corners = bound * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    axes.fill(*corners.T, color="0.8", label="what friction can bear")
    axes.plot([0, f_1], [0, f_2], "o-", color="tab:red", markevery=[1], label="the friction")
    axes.set(aspect="equal", xlabel="$f_{d_1}$ [N]", ylabel="$f_{d_2}$ [N]")


def cone(mu_v, push, torque):
    """The section of the cone at the normal force and moment, with what the table bears."""
    solution = qr.solve_step(block(push, mu_v, torque=torque))
    _, axes = plt.subplots(figsize=(4, 3.4), layout="constrained")
    draw_cone(axes, solution.wrench[0], mu_v)
    axes.legend(loc="lower left", fontsize="small")
    axes.set_title(f"slip {1e6 * solution.delta_q[0]:.1f} um")
    plt.show()


sliders = interact(
    cone,
    mu_v=FloatSlider(0.5, min=0.1, max=1.0, step=0.1),
    push=FloatSlider(3.0, min=0.0, max=9.0, step=0.5),
    torque=FloatSlider(0.0, min=0.0, max=0.3, step=0.02, readout_format=".2f"),
)
# %% [markdown]
# The same as a static figure, for two pushes:

# %%
figure, both = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
for axes, push in zip(both, (3.0, 6.0), strict=True):
    solution = qr.solve_step(block(push))
    draw_cone(axes, solution.wrench[0], 0.5)
    axes.set_title(f"push {push:g} N: slip {1e6 * solution.delta_q[0]:.0f} um")
both[0].legend(loc="lower left", fontsize="small")
plt.show()

# %% [markdown]
# ## Stick and slip
#
# Up to mu_v m g nothing moves, exactly. Beyond, the block slides, and it has to rise by mu_v dx in order to do so.


# %%
def slips(mu_v):
    """Slip and rise against the push, with the formula of (R8)."""
    pushes = np.linspace(0.0, 10.0, 41)
    moved = np.array([qr.solve_step(block(push, mu_v)).delta_q for push in pushes])
    beyond = np.maximum(pushes - mu_v * GRAVITY, 0.0)
    formula = H**2 * beyond / (1 + mu_v**2)
    assert np.abs(moved[:, 0] - formula).max() < 1e-12
    _, axes = plt.subplots(figsize=(4.8, 3.2), layout="constrained")
    axes.plot(pushes, 1e6 * formula, color="0.6", linewidth=3, label="slip, (R8)")
    axes.plot(pushes, 1e6 * moved[:, 0], "k.", label="slip")
    axes.plot(pushes, 1e6 * moved[:, 2], "k--", label="rise")
    axes.set(xlabel="push [N]", ylabel="in one step [um]")
    axes.legend()
    plt.show()


slider = interact(slips, mu_v=FloatSlider(0.5, min=0.1, max=0.9, step=0.1))
# %% [markdown]
# The same as a static figure, for mu_v = 0.5:

# %%
slips(0.5)

# %% [markdown]
# ## The multipliers of a stick
#
# A multiplier is the impulse of a row, along an edge of the cone. The block sticks at 3 N. Of six rows of rank four, only the sum A' lam is unique: the certificate says that the multipliers are not.

# %%
held = qr.solve_step(block(3.0))
print("delta_q [m, rad]:", held.delta_q)
print("lam / h [N]:", (held.lam / H).round(3))
print("multipliers unique:", held.certificate.multipliers_unique)
print("wrench (f_1, f_2, f_n, tau_n) [N, N m]:", held.wrench[0].round(3))
assert not held.delta_q.any()

# %% [markdown]
# The pairs of opposite rows give the friction: lam of -d1 less that of +d1 is what pushes back.

# %%
figure, axes = plt.subplots(figsize=(4.8, 2.8), layout="constrained")
axes.bar(["+d1", "+d2", "-d1", "-d2", "+spin", "-spin"], held.lam / H, color="0.4")
axes.set_ylabel("multiplier / h [N]")
axes.set_title(f"their sum is the weight, {held.lam.sum() / H:.2f} N")
plt.show()
