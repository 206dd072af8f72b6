"""
The least squeeze that holds a bar
==================================

Two fingers hold a bar at a distance d from its centre of mass. The weight pulls the bar down, and
turns it about the axis of the fingers.

Against sliding alone each finger has to press with N_f = m g / (2 mu_v), against the turn alone
with N_tau = m g d / (2 mu_omega). In the paper's pyramid both loads share one normal force,
N_f + N_tau. In the ellipsoid it is the root of N_f^2 + N_tau^2, and in the product of both limits
the larger one.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

m, mu_v, mu_omega, gravity, stiffness, half_width = 0.2, 0.5, 0.02, 9.81, 1000.0, 0.03

# %%
# q_a: how far each finger has closed, along +x and -x; q_u: the twist of the bar.
normals = np.array([[1.0, 0, 0], [-1.0, 0, 0]])
d1 = np.array([[0.0, 1, 0], [0.0, 1, 0]])
d2 = np.cross(normals, d1)


def holds(cone, squeeze, lever):
    """Whether the bar stays where it is, at a squeeze [N] of fingers at a lever [m]."""
    J = np.zeros((2, 4, 8))
    for j, n in enumerate(normals):
        J[j, :3, j] = -n  # the finger approaches the bar along n
        x, y, z = lever * d1[j] - half_width * n
        J[j, :3, 2:5] = np.eye(3)
        J[j, :3, 5:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        J[j, 3, 5:] = n
    fingers = qr.Contacts(
        name=("left/bar", "right/bar"), phi=[0.0, 0.0], n=normals, d1=d1, d2=d2, J=J,
        mu_v=[mu_v, mu_v], mu_omega=[mu_omega, mu_omega], rows=[6, 6],
    )  # fmt: skip
    step = qr.StepData(
        h=0.01, K_q=stiffness * np.eye(2), M_u=np.diag([m, m, m, 1e-4, 1e-4, 1e-4]),
        tau_a=np.zeros(2), tau_u=[0, 0, -m * gravity, 0, 0, 0],
        delta_q_bar_a=np.full(2, squeeze / stiffness), contacts=fingers, cone=cone,
    )  # fmt: skip
    return np.abs(qr.solve_step(step).delta_q).max() < 1e-12


# %%
# Three per cent less than the formula slips, three per cent more holds.
levers = np.linspace(0, 0.06, 7)
N_f = m * gravity / (2 * mu_v)
N_tau = m * gravity * levers / (2 * mu_omega)
least = {
    "pyramid": N_f + N_tau,
    "ellipsoid": np.hypot(N_f, N_tau),
    "product": np.maximum(N_f, N_tau),
}

figure, axes = plt.subplots(figsize=(6.3, 3.2), layout="constrained")
for (cone, forces), line in zip(least.items(), ("-", "--", "-."), strict=True):
    assert not any(holds(cone, 0.97 * N, d) for N, d in zip(forces, levers, strict=True))
    assert all(holds(cone, 1.03 * N, d) for N, d in zip(forces, levers, strict=True))
    axes.plot(1e3 * levers, forces, line, label=f"{cone}, formula")
    last = cone == "product"
    axes.plot(1e3 * levers, 1.03 * forces, "k^", label="a step holds" if last else None)
    axes.plot(1e3 * levers, 0.97 * forces, "kv", markerfacecolor="none",
              label="a step slips" if last else None)  # fmt: skip
axes.set(xlabel="lever d [mm]", ylabel="squeeze of each finger [N]")
axes.set_title("In the pyramid both loads add up")
figure.legend(loc="outside right center")
plt.show()
