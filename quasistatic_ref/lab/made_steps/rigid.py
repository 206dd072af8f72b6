"""Steps of one kind of coordinates, of given programs, and of one free body against the world.

The coordinates of that body are its twist at the centre of mass, axes along the world's.
"""

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.lab.made_steps.contacts import contacts_of, no_contacts, point_jacobian
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Contacts, Extra, StepData


def free_step(M: ArrayLike, force: ArrayLike, contacts: Contacts, h: float) -> StepData:
    """A step without anything actuated."""
    none = np.zeros(0)
    return StepData(h, np.zeros((0, 0)), np.asarray(M), none, np.asarray(force), none, contacts)


def actuated_step(
    K_q: ArrayLike, tau_a: ArrayLike, delta_q_bar_a: ArrayLike, contacts: Contacts, h: float
) -> StepData:
    """A step with nothing but actuated coordinates."""
    K_q, tau_a, target = (np.asarray(x, dtype=np.float64) for x in (K_q, tau_a, delta_q_bar_a))
    return StepData(h, K_q, np.zeros((0, 0)), tau_a, np.zeros(0), target, contacts)


def program_step(H: Array, g: Array, A: Array, b: Array) -> StepData:
    """The step whose standard form is a given program: h = 1, K_q = H, tau_a = g, rows as extra.

    Parameters
    ----------
    H : ndarray, shape (n, n)
    g : ndarray, shape (n,)
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)
    """
    rows = Extra(tuple(f"row {i}" for i in range(len(b))), A, b)
    return actuated_step(H, g, np.zeros(len(g)), no_contacts(len(g)), h=1.0).replace(extra=rows)


def conic_step(H: Array, g: Array, F: Array, phi: Array) -> StepData:
    """The step whose standard form is a program with second-order cones.

    Parameters
    ----------
    H : ndarray, shape (n, n)
    g : ndarray, shape (n,)
    F : ndarray, shape (blocks, 4, n)
        (F x)_0 + phi >= |(F x)_1:3| for each block.
    phi : ndarray, shape (blocks,)
    """
    frames = np.tile(np.eye(3), (len(F), 1, 1))  # along J's rows, of which the third is along n
    contacts = contacts_of(phi, frames, F[:, [1, 2, 0, 3]], 1.0, 1.0, rows=6)
    return actuated_step(H, g, np.zeros(len(g)), contacts, h=1.0).replace(cone=ELLIPSOID)


def rigid_step(
    m: float,
    inertia: ArrayLike,
    wrench: ArrayLike,
    points: ArrayLike,
    frames: ArrayLike,
    *,
    mu_v: ArrayLike,
    mu_omega: ArrayLike = 0.0,
    phi: ArrayLike = 0.0,
    rows: int = 4,
    h: float = 0.01,
) -> StepData:
    """One rigid body that touches the world.

    Parameters
    ----------
    m : float
        [kg].
    inertia : array_like, shape () or (3,)
        Principal moments along the axes of the world [kg m^2].
    wrench : array_like, shape (6,)
        Force and torque at the centre of mass, gravity included [N, N m].
    points : array_like, shape (n_c, 3)
        Contact points from the centre of mass [m].
    frames : array_like, shape (n_c, 3, 3)
        Rows d1, d2, n; n points from the world into the body.
    mu_v, mu_omega, phi, rows, h
        Those of the notation, each for all contacts or for one after the other.
    """
    frames = np.reshape(frames, (-1, 3, 3))
    J = point_jacobian(points, frames[:, 2])
    M = np.diag([m, m, m, *np.broadcast_to(inertia, 3)])
    return free_step(M, wrench, contacts_of(phi, frames, J, mu_v, mu_omega, rows), h)


def point_step(m: float, force: ArrayLike, mu_v: float, phi: float, h: float) -> StepData:
    """A point mass over a plane; delta_q is its displacement in the world [m]."""
    contact = contacts_of(phi, np.eye(3), np.eye(4, 3)[None], mu_v)
    return free_step(m * np.eye(3), force, contact, h)


def sphere_step(
    m: float,
    inertia: float,
    radius: float,
    wrench: ArrayLike,
    *,
    mu_v: float,
    mu_omega: float,
    phi: float,
    h: float,
) -> StepData:
    """A sphere over the floor z = 0; wrench at its centre."""
    below = [[0.0, 0.0, -radius]]
    return rigid_step(
        m, inertia, wrench, below, [np.eye(3)],
        mu_v=mu_v, mu_omega=mu_omega, phi=phi, rows=6, h=h,
    )  # fmt: skip
