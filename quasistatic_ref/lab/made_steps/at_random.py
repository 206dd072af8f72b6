"""Random contacts, matrices and steps. The order of the draws is part of what a seed means."""

from typing import Any

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import contacts_of, repeated
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import Contacts, StepData

Rng = np.random.Generator


def random_frames(rng: Rng, n_c: int) -> Array:
    """Random right-handed frames, shape (n_c, 3, 3)."""
    R = np.linalg.qr(rng.standard_normal((n_c, 3, 3)))[0]
    return np.asarray(R * np.sign(np.linalg.det(R))[:, None, None])


def random_contacts(rng: Rng, n_c: int, n_v: int, **fixed: Any) -> Contacts:
    """Random contacts; a field given by name replaces the random one, for all contacts alike."""
    frames = random_frames(rng, n_c)
    phi = 1e-3 * rng.standard_normal(n_c)
    J = rng.standard_normal((n_c, 4, n_v))
    mu_v = rng.uniform(0.1, 1.0, n_c)
    mu_omega = rng.uniform(0.001, 0.02, n_c)
    rows = rng.choice([4, 6], n_c)
    contacts = contacts_of(phi, frames, J, mu_v, mu_omega, rows)
    fields = {key: np.broadcast_to(v, getattr(contacts, key).shape) for key, v in fixed.items()}
    return repeated(contacts, range(n_c), **fields)


def spread_matrix(rng: Rng, n: int, size: float, ratio: float = 1.0) -> Array:
    """A random symmetric positive definite matrix, shape (n, n).

    Its diagonal has about the `size` [any unit] and spans a `ratio` [-].
    """
    scale = np.sqrt(size / np.geomspace(1, ratio, n)) if n else np.zeros(0)
    L = np.tril(0.3 * rng.standard_normal((n, n)), -1) + np.eye(n)
    S = scale[:, None] * (L @ L.T) * scale
    return np.asarray((S + S.T) / 2)


def random_step(
    rng: Rng, n_a: int, n_u: int, contacts: Contacts, ratio: float = 1.0, cone: str = "pyramid"
) -> StepData:
    """A random step on given contacts: targets 1 mm off, 1 kN/m, masses 1 kg over a `ratio` [-]."""
    return StepData(
        h=0.01,
        K_q=spread_matrix(rng, n_a, 1e3, ratio),
        M_u=spread_matrix(rng, n_u, 1.0, ratio),
        tau_a=rng.standard_normal(n_a),
        tau_u=rng.standard_normal(n_u),
        delta_q_bar_a=1e-3 * rng.standard_normal(n_a),
        contacts=contacts,
        cone=cone,
    )
