"""Random steps that look like a grasp: the family that exact certification is timed on.

A gripper of n_a coordinates (a stiff floating base and widths) holds bodies of six coordinates
each; contacts are between the gripper and a body (six rows) or a floor and a body (four rows).
"""

from __future__ import annotations

import numpy as np

from quasistatic_ref.step.data import Array, Contacts, StepData


def grasp_step(
    rng: np.random.Generator,
    n_u: int = 6,
    n_a: int = 7,
    grip: int = 10,
    floor: int = 5,
) -> StepData:
    """A body squeezed between two fingers, above or on a floor.

    Parameters
    ----------
    rng : numpy.random.Generator
    n_u : int
        Six per body.
    n_a : int
        Six for the base of the gripper, one per further width.
    grip, floor : int
        Contacts of each kind.

    Returns
    -------
    StepData
        SI units: bodies of about 0.2 kg and 0.1 m, stiffness of 1 kN/m, h = 0.01 s.
    """
    h, bodies, n_c = 0.01, n_u // 6, grip + floor
    M_u = np.zeros((n_u, n_u))
    tau_u = np.zeros(n_u)
    for k in range(bodies):
        mass, R = 0.2 * (1 + rng.random()), rotation(rng)
        inertia = R @ np.diag(mass * 1e-3 * (0.5 + rng.random(3))) @ R.T
        M_u[6 * k : 6 * k + 3, 6 * k : 6 * k + 3] = mass * np.eye(3)
        M_u[6 * k + 3 : 6 * k + 6, 6 * k + 3 : 6 * k + 6] = (inertia + inertia.T) / 2
        tau_u[6 * k + 2] = -9.81 * mass
    K_q = np.diag([800.0, 800, 800, 20, 20, 20, *([2000.0] * (n_a - 6))])
    lift = np.array([0, 0, rng.choice([0.0, 2e-4]), 0, 0, 0])
    squeeze = rng.uniform(0, 2e-3, n_a - 6)
    delta_q_bar_a = np.concatenate([lift + 1e-5 * rng.standard_normal(6), -squeeze])

    n, J = np.zeros((n_c, 3)), np.zeros((n_c, 4, n_a + n_u))
    for j in range(n_c):
        k = j % bodies
        if j < grip:
            side = 1.0 if j % 2 else -1.0
            n[j] = unit(np.array([side, 0, 0]) + 0.05 * rng.standard_normal(3))
            at = np.array([-0.03 * side, 0, 0]) + 0.005 * rng.standard_normal(3)
        else:
            n[j], side = np.array([0.0, 0, 1]), 0.0
            at = np.array([*(0.04 * rng.standard_normal(2)), -0.04])
        body = slice(n_a + 6 * k, n_a + 6 * k + 6)
        J[j, :3, body] = np.hstack([np.eye(3), -skew(at)])
        J[j, 3, body] = np.concatenate([np.zeros(3), n[j]])
        if j < grip:
            J[j, :3, :6] = -np.hstack([np.eye(3), -skew(at)])
            J[j, 3, :6] = -np.concatenate([np.zeros(3), n[j]])
            J[j, 0, 6 + k % max(n_a - 6, 1)] -= -side * 0.5
    d1 = np.stack([unit(np.cross(v, [0.0, 1, 0])) for v in n])
    return StepData(
        h=h,
        K_q=K_q,
        M_u=M_u,
        tau_a=np.zeros(n_a),
        tau_u=tau_u,
        delta_q_bar_a=delta_q_bar_a,
        contacts=Contacts(
            name=tuple(f"{'grip' if j < grip else 'floor'}/{j}" for j in range(n_c)),
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


def skew(v: Array) -> Array:
    """The matrix of v x, shape (3, 3)."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def unit(v: Array) -> Array:
    """The direction of v."""
    return v / np.linalg.norm(v)


def rotation(rng: np.random.Generator) -> Array:
    """A random orthogonal matrix, shape (3, 3)."""
    return np.linalg.qr(rng.standard_normal((3, 3)))[0]


def random_step(
    rng: np.random.Generator,
    n_a: int,
    n_u: int,
    n_c: int,
    mass_ratio: float = 1.0,
) -> StepData:
    """Anything that a step may be: duplicated contacts, penetration, mu = 0, light beside heavy.

    Parameters
    ----------
    rng : numpy.random.Generator
    n_a, n_u, n_c : int
        Coordinates of either kind, and contacts.
    mass_ratio : float
        Largest mass over smallest, and largest stiffness over smallest.

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    frames = [rotation(rng) for _ in range(n_c)]
    frames = [R * np.sign(np.linalg.det(R)) for R in frames]
    J = rng.standard_normal((n_c, 4, n_a + n_u))
    J *= rng.random((n_c, 1, n_a + n_u)) < 0.7  # some coordinates do not move a contact
    phi = rng.choice([0.0, 1e-3, -1e-4], n_c) * rng.random(n_c)
    mu_v = rng.choice([0.0, 0.5, 1.0], n_c) * rng.random(n_c)
    mu_omega = rng.choice([0.0, 0.01], n_c)
    same = np.arange(n_c)
    for j in range(1, n_c):
        if rng.random() < 0.3:
            same[j] = same[rng.integers(j)]
    n = np.array([frames[j][:, 2] for j in same]).reshape(n_c, 3)
    return StepData(
        h=0.01,
        K_q=spread_matrix(rng, n_a, 1e3, mass_ratio),
        M_u=spread_matrix(rng, n_u, 1.0, mass_ratio),
        tau_a=rng.standard_normal(n_a),
        tau_u=rng.choice([0.0, 1.0]) * rng.standard_normal(n_u),
        delta_q_bar_a=1e-3 * rng.standard_normal(n_a),
        contacts=Contacts(
            name=tuple(f"c{j}" for j in range(n_c)),
            phi=phi[same],
            n=n,
            d1=np.array([frames[j][:, 0] for j in same]).reshape(n_c, 3),
            d2=np.array([frames[j][:, 1] for j in same]).reshape(n_c, 3),
            J=J[same],
            mu_v=mu_v[same],
            mu_omega=mu_omega[same],
            rows=rng.choice([4, 6], n_c),
        ),
    )


def mixed_step(seed: int) -> StepData:
    """A step of either family: every fifth a grasp, the others of up to 12 coordinates.

    Parameters
    ----------
    seed : int
        Each seed is another step; masses are 1, 1e4 or 1e9 apart.

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    rng = np.random.default_rng(seed)
    if seed % 5 == 0:
        return grasp_step(rng)
    n_a, n_u = int(rng.integers(0, 7)), int(rng.integers(0, 7))
    n_u += n_a + n_u == 0
    return random_step(rng, n_a, n_u, int(rng.integers(0, 8)), rng.choice([1.0, 1e4, 1e9]))


def spread_matrix(rng: np.random.Generator, n: int, size: float, ratio: float) -> Array:
    """A positive definite matrix whose diagonal spans a ratio, shape (n, n)."""
    scale = np.sqrt(size / np.geomspace(1, ratio, n)) if n else np.zeros(0)
    L = np.tril(0.3 * rng.standard_normal((n, n)), -1) + np.eye(n)
    S = scale[:, None] * (L @ L.T) * scale
    return (S + S.T) / 2
