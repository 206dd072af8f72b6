"""Steps of ordinary and of strange numbers; matrices that are nearly singular."""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import count

import numpy as np

from quasistatic_ref import InputError
from tests.oracles.random_steps import any_step, mixed_step
from tests.oracles.rational_kkt import exact

CONES = "pyramid", "product", "frictionless"

SCALES = 12.0
"""Largest power of ten by which a number of a step is multiplied."""
SHARE = Fraction(1e-14)
"""Of its diagonal entry, what a pivot of a positive definite matrix has to be above."""


def hostile_step(rng):
    """A step of :func:`any_step` whose numbers are multiplied by powers of ten, one to all of them.

    Raises
    ------
    InputError
        If the numbers are no step.
    """
    draw = np.random.default_rng(rng.getrandbits(64))
    n_a = draw.integers(0, 7)
    n_u = draw.integers(0, 7)
    n_c = draw.integers(1, 9)
    n_u += n_a + n_u == 0
    step = any_step(draw, int(n_a), int(n_u), int(n_c), draw.choice([1.0, 1e4, 1e9]))
    often = draw.choice([0.15, 0.5, 1.0])

    def scale(*shape):
        """Powers of ten, of shape `shape`, most of them 1."""
        powers = draw.uniform(-SCALES, SCALES, shape) * (draw.random(shape) < often)
        return np.asarray(10.0 ** (powers if draw.random() < 0.5 else powers.round()))

    c = step.contacts
    S = scale(n_a + n_u) if draw.random() < 0.3 else scale()  # one for each coordinate, or for all
    S = np.broadcast_to(S, n_a + n_u)
    contacts = replace(
        c, phi=c.phi * scale(n_c) * scale(),
        J=c.J * S * (scale(n_c)[:, None, None] if draw.random() < 0.3 else scale()),
        mu_v=np.minimum(c.mu_v * scale(n_c), 1e12), mu_omega=c.mu_omega * scale(),
    )  # fmt: skip
    return step.replace(
        h=step.h * float(scale()),
        K_q=step.K_q * scale() * np.outer(S[:n_a], S[:n_a]),
        M_u=step.M_u * scale() * np.outer(S[n_a:], S[n_a:]),
        tau_a=step.tau_a * scale() * S[:n_a],
        tau_u=step.tau_u * scale() * S[n_a:],
        delta_q_bar_a=step.delta_q_bar_a * scale() / S[:n_a],
        contacts=contacts,
    )


def subnormal(rng, step):
    """The same step with loads, targets and gaps smaller by one large power of two."""
    small = 2.0 ** -int(rng.integers(900, 1075))
    far = replace(step.contacts, phi=step.contacts.phi * small)
    loads = {name: getattr(step, name) * small for name in ("tau_a", "tau_u", "delta_q_bar_a")}
    return step.replace(contacts=far, **loads)


def steps(family):
    """Steps of a family, without end."""
    for seed in count():
        rng = np.random.default_rng(seed)
        try:
            step = hostile_step(random.Random(seed)) if "scales" in family else mixed_step(seed)
            if family == "subnormal loads":
                step = subnormal(rng, step)
            elif family == "nearly singular":
                K_q, M_u = (singular(rng, n, 2e-14) for n in (step.n_a, step.n_u))
                step = step.replace(K_q=K_q, M_u=M_u)
            yield step.replace(cone=CONES[seed % 3])
        except InputError:
            continue


def singular(rng, n, share=None):
    """A symmetric matrix (n, n) whose last pivot has about this share of its diagonal entry."""
    if share is None:
        share = float(rng.choice([0.0, -1e-14, 1e-15, 1e-14, 1e-14 * (1 + 1e-9), 1e-13, 1e-12]))
        share *= float(rng.choice([1.0, rng.uniform(0.5, 2.0)]))
    L = np.tril(rng.standard_normal((n, n)), -1) + np.diag(rng.uniform(0.5, 2.0, n))
    if rng.random() < 0.5:  # whole numbers: their products are exact
        L = np.round(4 * L) + 4 * np.eye(n)
    at = int(rng.integers(n)) if n else 0
    pivots = np.ones(n)
    pivots[at : at + 1] = share * float(L[at, :at] @ L[at, :at]) if at else max(share, 0.0)
    S = (L / np.diag(L)) @ np.diag(pivots) @ (L / np.diag(L)).T
    if rng.random() < 0.3:
        unit = 10.0 ** rng.uniform(-150, 150, n) if rng.random() < 0.5 else 2.0**-520
        S = S * unit * np.reshape(unit, (-1, 1)) if np.ndim(unit) else S * unit * unit
    return np.tril(S) + np.tril(S, -1).T


def positive_definite(S):
    """Whether all pivots are above their share of the diagonal, in fractions."""
    rest = exact(S)
    diagonal = [row[i] for i, row in enumerate(rest)]
    for k, entry in enumerate(diagonal):
        pivot = rest[k]
        if pivot[k] <= 0 or pivot[k] <= SHARE * entry:
            return False
        for i in range(k + 1, len(rest)):
            factor = rest[i][k] / pivot[k]
            rest[i] = [v - factor * w for v, w in zip(rest[i], pivot, strict=True)]
    return True
