"""Lesson 2: a spring, and step after step

A finger on a spring of K_q, its target ahead; a block of mass m at a gap phi from it, on ice.
"""

# %% setup
from dataclasses import replace

import numpy as np

import quasistatic_ref as qr

CONTACT = qr.Contacts(
    name=("finger/block",), phi=[0.0], n=[[1, 0, 0]], d1=[[0, 1, 0]], d2=[[0, 0, 1]],
    J=[[[-1, 1], [0, 0], [0, 0], [0, 0]]], mu_v=[0.0], mu_omega=[0.0], rows=[4],
)  # fmt: skip


def step_of(K_q, m, h, target, phi):
    return qr.StepData(
        h=h, K_q=[[K_q]], M_u=[[m]], tau_a=[0.0], tau_u=[0.0], delta_q_bar_a=[target],
        contacts=replace(CONTACT, phi=[phi]),
    )  # fmt: skip


CASES = [(500, 0.5, 0.02, 4e-3, 1e-3), (80, 2.0, 0.01, 2e-3, 1e-3), (80, 2.0, 0.01, 1e-3, 2e-3)]

# %% task
"""How far finger and block go [m], in closed form. Mind the case in which they do not meet."""


def motions(K_q, m, h, target, phi):
    return 0.0, 0.0


# %% answer
def motions(K_q, m, h, target, phi):
    if target <= phi:
        return target, 0.0
    finger = (h**2 * K_q * target + m * phi) / (h**2 * K_q + m)
    return finger, finger - phi


# %% check
check(
    "two unknowns",
    lambda: all(
        np.allclose(motions(*case), qr.solve_step(step_of(*case)).delta_q, rtol=1e-9, atol=0)
        for case in CASES
    ),
)

# %% task
"""The loop: places (finger, block) [m] after each of `steps` steps of a target that moves at v
[m/s], from (0, phi). The answer of a step is `qr.solve_step(step_of(...)).delta_q`."""


def run(K_q, m, h, v, phi, steps):
    return np.zeros((steps, 2))


# %% answer
def run(K_q, m, h, v, phi, steps):
    q = np.array([0.0, phi])
    places = []
    for k in range(steps):
        target = v * h * (k + 1)
        q = q + qr.solve_step(step_of(K_q, m, h, target - q[0], q[1] - q[0])).delta_q
        places.append(q)
    return np.array(places)


# %% check
def exact_places(K_q, m, h, v, phi, steps):
    """The same loop in closed form."""
    finger = 0.0
    block = phi
    places = []
    for k in range(1, steps + 1):
        target = v * h * k - finger
        gap = block - finger
        ahead = target if target <= gap else (h**2 * K_q * target + m * gap) / (h**2 * K_q + m)
        finger, block = finger + ahead, max(block, finger + ahead)
        places.append((finger, block))
    return np.array(places)


check(
    "the loop",
    lambda: np.allclose(
        run(500, 0.5, 0.02, 0.02, 1e-3, 40), exact_places(500, 0.5, 0.02, 0.02, 1e-3, 40), rtol=1e-9
    ),
)

# %% task
"""The force [N] between them in the steady state: the drag of the model."""


def drag(K_q, m, h, v):
    return 0.0


# %% answer
def drag(K_q, m, h, v):
    return m * v / h


# %% check
def steady(K_q, m, h, v):
    places = exact_places(K_q, m, h, v, 0.0, 4000)
    return K_q * (v * h * 4000 - places[-1, 0])


check(
    "drag",
    lambda: all(
        np.isclose(drag(500, 0.5, h, 0.02), steady(500, 0.5, h, 0.02)) for h in (0.02, 0.01)
    ),
)
