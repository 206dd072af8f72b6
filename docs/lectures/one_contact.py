"""Lesson 1: one contact, six rows

A block of 1 kg on a table may go along x, y, z and turn about z. mu_v = 0.5, mu_omega = 0.02 m.
"""

# %% setup
import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.step.standard_form import standard_form

MU_V = 0.5
MU_OMEGA = 0.02
MASS = 1.0
G = 9.81
H = 0.01
CONTACT = qr.Contacts(
    name=("table/block",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]],
    J=[np.eye(4)], mu_v=[MU_V], mu_omega=[MU_OMEGA], rows=[6],
)  # fmt: skip


def block(push_x=0.0, push_y=0.0, twist=0.0):
    tau_u = [push_x, push_y, -MASS * G, twist]
    return qr.StepData(
        h=H, K_q=np.zeros((0, 0)), M_u=np.diag([MASS, MASS, MASS, 1e-3]), tau_a=[],
        tau_u=tau_u, delta_q_bar_a=[], contacts=CONTACT,
    )  # fmt: skip


# %% task
"""Write the six rows of A, Eq. (8), in the order +d1, +d2, -d1, -d2, +spin, -spin."""
A = np.zeros((6, 4))

# %% answer
A = np.array([
    [MU_V, 0, 1, 0], [0, MU_V, 1, 0], [-MU_V, 0, 1, 0], [0, -MU_V, 1, 0],
    [0, 0, 1, MU_OMEGA], [0, 0, 1, -MU_OMEGA],
])  # fmt: skip

# %% check
check("six rows", lambda: np.array_equal(A, standard_form(block()).A))

# %% task
"""(R7): the largest push [N] that is held, at an angle psi from d1 [rad]."""


def largest_push(psi):
    return 0.0


# %% answer
def largest_push(psi):
    return MU_V * MASS * G / (abs(np.cos(psi)) + abs(np.sin(psi)))


# %% check
def holds(psi, share):
    push = share * largest_push(psi)
    return not qr.solve_step(block(push * np.cos(psi), push * np.sin(psi))).delta_q.any()


check(
    "threshold",
    lambda: all(
        largest_push(psi) > 0 and holds(psi, 0.999) and not holds(psi, 1.001)
        for psi in (0.0, 0.4, np.pi / 4, 2.0)
    ),
)

# %% task
"""(R8): how far the block slides and rises in one step under a push along x of 8 N [m]."""
dx = 0.0
dz = 0.0

# %% answer
dx = H**2 * (8.0 - MU_V * MASS * G) / (MASS * (1 + MU_V**2))
dz = MU_V * dx

# %% check
check("slip", lambda: np.allclose(qr.solve_step(block(8.0)).delta_q[[0, 2]], [dx, dz], rtol=1e-9))
