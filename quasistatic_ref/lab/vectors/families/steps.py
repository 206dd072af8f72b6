"""Random steps that families are made of: bodies, contacts and how hard they are pressed."""

from __future__ import annotations

from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.step.data import Array, Contacts, StepData
from quasistatic_ref.step.standard_form import standard_form

Rng = np.random.Generator


def frames(rng: Rng, n_c: int) -> Array:
    """Random right-handed frames, shape (n_c, 3, 3): rows d1, d2, n."""
    R = np.linalg.qr(rng.standard_normal((n_c, 3, 3)))[0]
    return np.asarray(R * np.sign(np.linalg.det(R))[:, None, None])


def contacts(rng: Rng, n_c: int, n_v: int, **fixed: Any) -> Contacts:
    """Random contacts; a field given by name replaces the random one, for all contacts alike."""
    axes = frames(rng, n_c)
    fields: dict[str, Any] = {
        "phi": 1e-3 * rng.standard_normal(n_c),
        "n": axes[:, 2],
        "d1": axes[:, 0],
        "d2": axes[:, 1],
        "J": rng.standard_normal((n_c, 4, n_v)),
        "mu_v": rng.uniform(0.1, 1.0, n_c),
        "mu_omega": rng.uniform(0.001, 0.02, n_c),
        "rows": rng.choice([4, 6], n_c),
    }
    for key, value in fixed.items():
        fields[key] = np.broadcast_to(value, fields[key].shape).copy()
    return Contacts(name=tuple(f"c{j}" for j in range(n_c)), **fields)


def repeated(given: Contacts, index: Any, **changes: Any) -> Contacts:
    """Some of the contacts, as often as their numbers occur, with some fields changed."""
    keys = ("phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
    fields = {key: getattr(given, key)[np.asarray(index)] for key in keys} | changes
    return Contacts(name=tuple(f"c{j}" for j in range(len(index))), **fields)


def spread(rng: Rng, n: int, size: float, ratio: float = 1.0) -> Array:
    """A random symmetric positive definite matrix, shape (n, n).

    Its diagonal has about the `size` [any unit] and spans a `ratio` [-].
    """
    scale = np.sqrt(size / np.geomspace(1, ratio, n)) if n else np.zeros(0)
    L = np.tril(0.3 * rng.standard_normal((n, n)), -1) + np.eye(n)
    S = scale[:, None] * (L @ L.T) * scale
    return np.asarray((S + S.T) / 2)


def step(
    rng: Rng, n_a: int, n_u: int, at: Contacts, ratio: float = 1.0, cone: str = "pyramid"
) -> StepData:
    """A random step on given contacts: targets 1 mm off, 1 kN/m, masses 1 kg over a `ratio` [-]."""
    return StepData(
        h=0.01,
        K_q=spread(rng, n_a, 1e3, ratio),
        M_u=spread(rng, n_u, 1.0, ratio),
        tau_a=rng.standard_normal(n_a),
        tau_u=rng.standard_normal(n_u),
        delta_q_bar_a=1e-3 * rng.standard_normal(n_a),
        contacts=at,
        cone=cone,
    )


def grasp(rng: Rng, grip: int = 10, floor: int = 5, n_bodies: int = 1) -> StepData:
    """Bodies squeezed between two fingers of a gripper with a floating base, over a floor."""
    n_a, n_u, n_c = 7, 6 * n_bodies, grip + floor
    n = np.tile([0.0, 0.0, 1.0], (n_c, 1))
    side = np.where(np.arange(n_c) % 2, 1.0, -1.0)
    n[:grip] = np.column_stack([side[:grip], 0.05 * rng.standard_normal((grip, 2))])
    n /= np.linalg.norm(n, axis=1)[:, None]
    d1 = np.cross(n, [0.0, 1.0, 0.0])
    d1 /= np.linalg.norm(d1, axis=1)[:, None]
    at = 0.01 * rng.standard_normal((n_c, 3))
    at[:grip, 0] -= 0.03 * side[:grip]
    at[grip:, 2] -= 0.04
    moves = np.zeros((n_c, 4, 6))  # of a point of a body, per unit of its twist, and its spin
    moves[:, :3, :3] = np.eye(3)
    for axis in range(3):
        moves[:, :3, 3 + axis] = np.cross(np.eye(3)[axis], at)
    moves[:, 3, 3:] = n
    J = np.zeros((n_c, 4, n_a + n_u))
    for j in range(n_c):
        body = n_a + 6 * (j % n_bodies)
        J[j, :, body : body + 6] = moves[j]
    J[:grip, :, :6] = -moves[:grip]
    J[:grip, 0, 6] = side[:grip] / 2
    mass = 0.2 * (1 + rng.random(n_bodies))
    M_u = np.diag(np.concatenate([[m, m, m, 2e-4, 3e-4, 4e-4] for m in mass]))
    target = 1e-5 * rng.standard_normal(n_a)
    target[[2, 6]] += rng.choice([0.0, 2e-4]), -rng.uniform(0, 2e-3)
    return StepData(
        h=0.01,
        K_q=np.diag([800.0, 800.0, 800.0, 20.0, 20.0, 20.0, 2000.0]),
        M_u=M_u,
        tau_a=np.zeros(n_a),
        tau_u=np.concatenate([[0, 0, -9.81 * m, 0, 0, 0] for m in mass]),
        delta_q_bar_a=target,
        contacts=Contacts(
            name=tuple(f"c{j}" for j in range(n_c)),
            phi=np.where(rng.random(n_c) < 0.5, 1e-6, 1e-4) * rng.standard_normal(n_c),
            n=n,
            d1=d1,
            d2=np.cross(n, d1),
            J=J,
            mu_v=rng.uniform(0.3, 0.9, n_c),
            mu_omega=rng.uniform(0.005, 0.02, n_c),
            rows=np.where(np.arange(n_c) < grip, 6, 4),
        ),
    )


def contact_entries(at: Contacts, keys: tuple[str, ...]) -> Json:
    """The contacts as a case holds them: a list of tables with these fields."""
    return [{key: getattr(at, key)[j].tolist() for key in keys} for j in range(at.n_c)]


def program(given: StepData) -> Json:
    """H, g, A, b of a step, in float64, as a case holds them; second-order cones likewise."""
    form = standard_form(given)
    H, g = form.H.tolist(), form.g.tolist()
    if given.cone != "ellipsoid":
        return {"H": H, "g": g, "A": form.A.tolist(), "b": form.b.tolist()}
    at = given.contacts
    torsion = np.where(at.rows == 6, at.mu_omega, 0.0)
    mu = np.stack([np.ones(at.n_c), at.mu_v, at.mu_v, torsion], axis=1)
    F = form.A.reshape(at.n_c, 4, -1) * mu[:, :, None]
    blocks = [
        {"F": F_j.tolist(), "f": [phi, 0.0, 0.0, 0.0]}
        for F_j, phi in zip(F, at.phi.tolist(), strict=True)
    ]
    return {"H": H, "g": g, "second_order": blocks}
