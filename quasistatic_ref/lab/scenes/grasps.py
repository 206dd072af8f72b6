"""Random steps that look like a grasp: bodies between two fingers, over a floor.

The coordinates are those of the gripper, a stiff floating base and widths, then the twist of each
body. Contacts are between the gripper and a body, six rows, or a floor and a body, four rows.
"""

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.scenes.contacts import (
    GRAVITY,
    X,
    Y,
    Z,
    contacts_of,
    frames_about,
    point_jacobian,
)
from quasistatic_ref.step.data import Array, Contacts, StepData

STIFFNESS = np.array([800.0, 800.0, 800.0, 20.0, 20.0, 20.0])
"""Of the gripper's base [N/m, N m/rad]; a width has 2 kN/m."""


def grasp_step(rng: Rng, n_u: int = 6, n_a: int = 7, grip: int = 10, floor: int = 5) -> StepData:
    """Bodies turned at random: the family that exact certification is timed on.

    Parameters
    ----------
    rng : numpy.random.Generator
    n_u : int
        Six per body.
    n_a : int
        Six for the base of the gripper, one per width.
    grip, floor : int
        Contacts of each kind.

    Returns
    -------
    StepData
        SI units: bodies of about 0.2 kg and 0.1 m, h = 0.01 s.
    """
    n_c, M_u, masses = grip + floor, np.zeros((n_u, n_u)), []
    for k in range(0, n_u, 6):
        mass, R = 0.2 * (1 + rng.random()), np.linalg.qr(rng.standard_normal((3, 3)))[0]
        inertia = R @ np.diag(mass * 1e-3 * (0.5 + rng.random(3))) @ R.T
        M_u[k : k + 3, k : k + 3] = mass * np.eye(3)
        M_u[k + 3 : k + 6, k + 3 : k + 6] = (inertia + inertia.T) / 2
        masses.append(mass)
    lift = np.array([0, 0, rng.choice([0.0, 2e-4]), 0, 0, 0])
    squeeze = rng.uniform(0, 2e-3, n_a - 6)
    target = np.concatenate([lift + 1e-5 * rng.standard_normal(6), -squeeze])
    side, n, at = _sides(grip, n_c), np.zeros((n_c, 3)), np.zeros((n_c, 3))
    for j in range(n_c):  # one contact after another, as their numbers are drawn
        if side[j]:
            n[j] = side[j] * X + 0.05 * rng.standard_normal(3)
            at[j] = -0.03 * side[j] * X + 0.005 * rng.standard_normal(3)
        else:
            n[j], at[j] = Z, [*(0.04 * rng.standard_normal(2)), -0.04]
        n[j] /= np.linalg.norm(n[j])
    return _step(M_u, masses, target, _held(rng, side, n, at, n_a, n_u))


def aligned_grasp_step(rng: Rng, grip: int = 10, floor: int = 5, n_bodies: int = 1) -> StepData:
    """Bodies whose principal axes are the world's, and a gripper of one width.

    Parameters
    ----------
    rng : numpy.random.Generator
    grip, floor : int
        Contacts of each kind.
    n_bodies : int

    Returns
    -------
    StepData
        Of the size of those of :func:`grasp_step`.
    """
    n_c = grip + floor
    side, n = _sides(grip, n_c), np.tile(Z, (n_c, 1))
    n[:grip] = np.column_stack([side[:grip], 0.05 * rng.standard_normal((grip, 2))])
    n /= np.linalg.norm(n, axis=1)[:, None]
    at = 0.01 * rng.standard_normal((n_c, 3))
    at[:grip, 0] -= 0.03 * side[:grip]
    at[grip:, 2] -= 0.04
    masses = 0.2 * (1 + rng.random(n_bodies))
    M_u = np.diag(np.concatenate([[m, m, m, 2e-4, 3e-4, 4e-4] for m in masses]))
    target = 1e-5 * rng.standard_normal(7)
    target[[2, 6]] += rng.choice([0.0, 2e-4]), -rng.uniform(0, 2e-3)
    return _step(M_u, masses, target, _held(rng, side, n, at, 7, 6 * n_bodies))


def _sides(grip: int, n_c: int) -> Array:
    """Which finger a contact is with, -1 or 1; 0 of the floor."""
    j = np.arange(n_c)
    return np.where(j < grip, np.where(j % 2, 1.0, -1.0), 0.0)


def _held(rng: Rng, side: Array, n: Array, at: Array, n_a: int, n_u: int) -> Contacts:
    """Contacts at points of the bodies in turn, gaps and friction at random."""
    n_c, of_point = len(n), point_jacobian(at, n)
    J = np.zeros((n_c, 4, n_a + n_u))
    for j in range(n_c):
        body = j % (n_u // 6)
        J[j, :, n_a + 6 * body : n_a + 6 * body + 6] = of_point[j]
        if side[j]:
            J[j, :, :6] = -of_point[j]
            J[j, 0, 6 + body % max(n_a - 6, 1)] += side[j] / 2
    return contacts_of(
        phi=np.where(rng.random(n_c) < 0.5, 1e-6, 1e-4) * rng.standard_normal(n_c),
        frames=frames_about(n, -Y),
        J=J,
        mu_v=rng.uniform(0.3, 0.9, n_c),
        mu_omega=rng.uniform(0.005, 0.02, n_c),
        rows=np.where(side == 0, 4, 6),
    )


def _step(M_u: Array, masses: ArrayLike, target: Array, contacts: Contacts) -> StepData:
    tau_u = np.zeros(len(M_u))
    tau_u[2::6] = -GRAVITY * np.asarray(masses)
    return StepData(
        h=0.01,
        K_q=np.diag([*STIFFNESS, *[2000.0] * (len(target) - 6)]),
        M_u=M_u,
        tau_a=np.zeros(len(target)),
        tau_u=tau_u,
        delta_q_bar_a=target,
        contacts=contacts,
    )
