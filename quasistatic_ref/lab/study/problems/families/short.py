"""Steps whose numbers are short, so that the rows of their quadratic program are not rounded.

J has 24 bits, friction 8: each entry of A is then a sum of two products that float64 holds, and the
rows of a sticking contact have the rank that they have in the model. Rounded rows would split ties
at 1e-17, which no solver sees and which no model means.
"""

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.lab.scenes.at_random import Rng, spread_matrix
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.step.data import Array, Contacts, StepData

H: float = 2.0**-7
"""Time step [s]: H of a step is formed without rounding."""
OF_J, OF_FRICTION = 24, 8
"""Bits."""


def shortened(values: ArrayLike, bits: int) -> Array:
    """Numbers rounded to so many bits, any shape, in their own unit."""
    part, exponent = np.frexp(np.asarray(values, dtype=np.float64))
    return np.asarray(np.ldexp(np.round(np.ldexp(part, bits)), exponent - bits)) + 0.0


def short_step(step: StepData) -> StepData:
    """A step like another, each contact seen in its own frame, with h = 2^-7 s and short numbers.

    Parameters
    ----------
    step : StepData
    """
    return step.replace(
        h=H,
        K_q=shortened(step.K_q, OF_J),
        M_u=shortened(step.M_u, OF_J),
        contacts=short_contacts(step.contacts),
    )


def with_axes(rng: Rng, step: StepData) -> StepData:
    """The step with stiffnesses and inertias along axes of their own: H is then not diagonal.

    Parameters
    ----------
    rng : Generator
    step : StepData
        Whose un-actuated coordinates are those of free bodies, six each.
    """
    n_a = step.n_a
    M_u = step.M_u.copy()
    unit = np.sqrt(np.diag(step.K_q))
    K_q = unit[:, None] * spread_matrix(rng, n_a, 1.0) * unit
    for i in range(3, step.n_u, 6):
        own = slice(i, i + 3)
        M_u[own, own] = spread_matrix(rng, 3, float(M_u[i, i]), 3.0)
    return step.replace(K_q=shortened(K_q, OF_J), M_u=shortened(M_u, OF_J))


def short_contacts(given: Contacts) -> Contacts:
    """Contacts in their own frames, with short J, gaps and friction."""
    frames = np.stack([given.d1, given.d2, given.n], axis=1)
    J = given.J.copy()
    J[:, :3] = frames @ given.J[:, :3]
    return framed(shortened(J, OF_J), shortened(given.phi, OF_J), given.mu_v, given.mu_omega,
                  given.rows)  # fmt: skip


def framed(
    J: Array, phi: ArrayLike, mu_v: ArrayLike, mu_omega: ArrayLike = 0.0, rows: ArrayLike = 4
) -> Contacts:
    """Contacts whose J is along d1, d2, n and spin, friction shortened.

    Parameters
    ----------
    J : ndarray, shape (n_c, 4, n_v)
    phi, mu_v, mu_omega, rows : array_like, shape () or (n_c,)
        Those of the notation.
    """
    own = np.tile(np.eye(3), (len(J), 1, 1))
    return contacts_of(phi, own, J, shortened(mu_v, OF_FRICTION),
                       shortened(mu_omega, OF_FRICTION), rows)  # fmt: skip
