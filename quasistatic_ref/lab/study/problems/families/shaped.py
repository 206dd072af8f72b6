"""Grasps in which one number is turned: condition, friction, gaps, dependence of the rows."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.lab.study.problems.families.short import framed, short_step, with_axes
from quasistatic_ref.step.data import Array, StepData

Turned = Callable[[Rng, float], StepData]
GRIP, FLOOR = 4, 3
"""Contacts of each kind: 36 rows in 13 coordinates."""
TORSION = 0.02
"""mu_omega over mu_v [m]."""


def base(rng: Rng) -> StepData:
    """A body in a gripper of one width, over the floor; K_q is dense."""
    return with_axes(rng, short_step(grasp_step(rng, grip=GRIP, floor=FLOOR)))


def conditioned(rng: Rng, condition: float) -> StepData:
    """A gripper whose dense K_q has a `condition` number [-], its diagonal about the same.

    Scaling the coordinates, which all natural units do, leaves the most of it.
    """
    step = base(rng)
    n_a = step.n_a
    Q = np.linalg.qr(rng.standard_normal((n_a, n_a)))[0]
    unit = np.sqrt(np.diag(step.K_q))
    K_q = unit[:, None] * ((Q * np.geomspace(1.0, 1.0 / condition, n_a)) @ Q.T) * unit
    return step.replace(K_q=(K_q + K_q.T) / 2)


def rubbed(rng: Rng, mu: float) -> StepData:
    """All contacts with one friction coefficient [-]."""
    step = base(rng)
    c = step.contacts
    # Gaps that are not negative: rigid enough friction leaves no way out of a penetration.
    return step.replace(contacts=framed(c.J, np.abs(c.phi), mu, TORSION * mu, c.rows))


def spaced(rng: Rng, gap: float) -> StepData:
    """Gaps between zero and a largest one [m]."""
    step = base(rng)
    c = step.contacts
    phi = np.float32(gap * rng.uniform(size=c.n_c)).astype(np.float64)
    return step.replace(contacts=framed(c.J, phi, c.mu_v, c.mu_omega, c.rows))


def copied(rng: Rng, copies: float) -> StepData:
    """Every contact so many times (`copies` [-]): the rank stays, and active rows multiply."""
    step = base(rng)
    n_c = step.contacts.n_c
    return step.replace(contacts=repeated(step.contacts, np.tile(np.arange(n_c), round(copies))))


def nearly_copied(rng: Rng, off: float) -> StepData:
    """Every contact twice, the second off by a part of the largest entries of J [-]."""
    step = base(rng)
    n_c = step.contacts.n_c
    c = repeated(step.contacts, np.tile(np.arange(n_c), 2))
    J: Array = c.J.copy()
    size = np.abs(c.J[n_c:]).max(axis=(0, 1))  # of each coordinate
    J[n_c:] += off * size * rng.standard_normal(c.J[n_c:].shape) * (c.J[n_c:] != 0)
    return step.replace(contacts=framed(J, c.phi, c.mu_v, c.mu_omega, c.rows))
