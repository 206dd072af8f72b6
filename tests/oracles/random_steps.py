"""One maker of random steps: a family, and traits that change what it makes.

Those that commands and the vectors draw are in ``lab/made_steps/at_random.py``.
"""

from contextlib import suppress
from dataclasses import replace
from itertools import count

import numpy as np
from scipy.linalg import block_diag

from quasistatic_ref import Extra, InputError, StepData
from tests.made import (
    GRAVITY,
    X,
    Y,
    Z,
    contacts_of,
    frames_about,
    free_step,
    point_jacobian,
    random_contacts,
    repeated,
    rigid_step,
    step_on,
)

POLYHEDRAL = ("pyramid", "product", "facets-6", "facets-8", "frictionless")
LOADS = ("tau_a", "tau_u", "delta_q_bar_a")
SCALES = 12.0
WIDE = 100.0
"""Largest powers of ten by which a number of a step is multiplied."""


def drawn(seed, of="mixed"):
    """A random step, infeasible in some cases.

    Parameters
    ----------
    seed : int or numpy.random.Generator
    of : str
        A family, then traits in the order in which they change the step: ``"any scales"``.
        Families are ``any``, with duplicated contacts, penetration, mu = 0, light on heavy, and
        ``small`` and ``body`` (nothing actuated) of fewer coordinates; ``grasp``; ``mixed``, of
        seeds alone, every fifth a grasp and the others any; the planar ``floor``, ``anywhere`` and
        ``wedge``. Traits are the functions of TRAITS.

    Raises
    ------
    InputError
        If the scaled numbers are no step.
    """
    rng = np.random.default_rng(seed)
    family, *traits = of.split()
    if family == "mixed":
        family = "any" if seed % 5 else "grasp"
    make = grasp if family == "grasp" else planar if family in PLANAR else any_step
    step = make(rng, family)
    for trait in traits:
        step = TRAITS[trait](rng, step)
    return step


def steps(of):
    """Those that are steps of the seeds 0, 1, ..., in one polyhedral cone after the other."""
    for seed in count():
        with suppress(InputError):
            yield drawn(seed, of).replace(cone=POLYHEDRAL[seed % len(POLYHEDRAL)])


MOST = {"any": ((0, 7), (0, 7), (0, 8)), "small": ((0, 3), (1, 4), (0, 4)),
        "body": ((0, 1), (1, 4), (0, 4))}  # fmt: skip
"""The numbers of actuated and other coordinates, and of contacts, of a family."""


def any_step(rng, family):
    """Anything that a step may be."""
    n_a, n_u, n_c = (int(rng.integers(*each)) for each in MOST[family])
    n_u += n_a + n_u == 0
    contacts = random_contacts(
        rng, n_c, n_a + n_u,
        phi=rng.choice([0.0, 1e-3, -1e-4], n_c) * rng.random(n_c),
        mu_v=rng.choice([0.0, 0.5, 1.0], n_c) * rng.random(n_c),
        mu_omega=rng.choice([0.0, 0.01], n_c),
    )  # fmt: skip
    moves = rng.random((n_c, 1, n_a + n_u)) < 0.7  # some coordinates do not move a contact
    each = np.arange(n_c)
    same = np.where(rng.random(n_c) < 0.3, rng.integers(0, each + 1), each)
    step = step_on(
        rng, n_a, n_u,
        repeated(contacts, same, J=(moves * contacts.J)[same], rows=rng.choice([4, 6], n_c)),
        rng.choice([1.0, 1e4, 1e9]),
    )  # fmt: skip
    return step.replace(tau_u=rng.choice([0.0, 1.0]) * step.tau_u)


def grasp(rng, _):
    """A body of some 0.2 kg and 0.1 m between ten contacts of two fingers, over five of a floor.

    The coordinates are those of the gripper, a stiff floating base and a width, then the twist of
    the body.
    """
    side = np.repeat([-1.0, 1.0, 0.0], 5)  # 0 is the floor
    gripped = side[:, None] != 0
    along = side[:, None] * X
    n, spread = rng.standard_normal((2, 15, 3))
    n = np.where(gripped, along + 0.05 * n, Z)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    mass = 0.2 * (1 + rng.random())
    body = rigid_step(
        mass, mass * 1e-3 * (0.5 + rng.random(3)), -GRAVITY * mass * np.eye(6)[2],
        np.where(gripped, 0.005 * spread - 0.03 * along, [0.04, 0.04, 0.0] * spread - 0.04 * Z),
        frames_about(n, -Y), mu_v=rng.uniform(0.3, 0.9, 15), mu_omega=rng.uniform(0.005, 0.02, 15),
        phi=np.where(rng.random(15) < 0.5, 1e-6, 1e-4) * rng.standard_normal(15),
        rows=np.where(side, 6, 4),
    )  # fmt: skip
    J = body.contacts.J
    of_gripper = np.where(gripped[..., None], -J, 0.0), side[:, None, None] / 2 * np.eye(4, 1)
    lift = rng.choice([0.0, 2e-4]) * np.eye(6)[2] + 1e-5 * rng.standard_normal(6)
    return StepData(
        h=body.h,
        K_q=np.diag([800.0] * 3 + [20.0] * 3 + [2000.0]),
        M_u=body.M_u,
        tau_a=np.zeros(7),
        tau_u=body.tau_u,
        delta_q_bar_a=np.append(lift, -rng.uniform(0, 2e-3)),
        contacts=replace(body.contacts, J=np.concatenate([*of_gripper, J], axis=2)),
    )


PLANAR = ("floor", "anywhere", "wedge")


def planar(rng, family):
    """A body that moves along x and z and turns about y, with one to four contacts.

    They are corners of a box on level ground, with exact ties; or points and normals of any
    direction; or two normals that nearly or exactly face each other.
    """
    m = rng.uniform(0.2, 2.0)
    n_c = int(rng.integers(2 if family == "wedge" else 1, 5))
    mu = rng.choice([rng.uniform(0.1, 1.0), rng.uniform(1.0, 5.0)])
    angles = rng.uniform(0.0, 2 * np.pi, n_c)
    points = rng.uniform(-0.1, 0.1, (n_c, 2))
    phi = rng.uniform(0.0, 2e-4, n_c) * (rng.random(n_c) < 0.3)
    force = m * rng.normal(size=3) * [10.0, 10.0, 0.3]
    if family == "floor":
        angles[:] = np.pi / 2
        points = np.array([[x, -0.05] for x in (-0.05, 0.05, 0.0, 0.025)])[:n_c]
        force[:2] = rng.uniform(0, 3) * mu * 9.81 * m, -9.81 * m
    if family == "wedge":
        angles = np.resize([np.pi / 2, -np.pi / 2], n_c) + rng.choice([0.0, 0.1]) * rng.normal()
        angles[1] += rng.choice([0.0, 0.5]) * rng.normal()
        phi *= 0.0
    M = np.diag([m, m, m * rng.uniform(0.001, 0.02)])
    return free_step(M, force, planar_contacts(phi, angles, points, mu), 0.01)


def planar_contacts(phi, angles, points, mu):
    """Contacts of a body with a world of normals at some angles [rad], at points [m] of it."""
    n = np.round(np.column_stack([np.cos(angles), np.sin(angles)]), 15)[:, :, None] + 0.0
    at = points[:, :1] * X + points[:, 1:] * Z
    n = n[:, 0] * X + n[:, 1] * Z
    return contacts_of(phi, frames_about(n, Y), point_jacobian(at, n)[..., [0, 2, 4]], mu)


def integers(rng, step):
    """Small integers and eighths: rows that depend on each other, and exact ties."""
    c = step.contacts
    J = rng.integers(-1, 2, c.J.shape).astype(np.float64)
    J[:, 2] = 1.0  # the normal is vertical
    phi, mu_v, mu_omega = (
        rng.choice(some, c.n_c) for some in ([0.0, 0.0, 0.125], [0.0, 0.5, 1.0], [0.0, 0.25])
    )
    frames = np.tile(np.eye(3)[[2, 0, 1]], (c.n_c, 1, 1))
    K_q, M_u = (np.diag(rng.choice([1.0, 2.0, 8.0], n)) for n in (step.n_a, step.n_u))
    loads = {name: rng.integers(-2, 3, len(getattr(step, name))) / 1.0 for name in LOADS}
    touching = contacts_of(phi, frames, J, mu_v, mu_omega, c.rows)
    return step.replace(h=0.5, K_q=K_q, M_u=M_u, contacts=touching, **loads)


def copies(rng, step):
    """Copies of a body with contacts, each with its own gaps, friction, loads and names.

    H and the numbers of contacts are equal, so that `fast` shares what it keeps of the groups. Some
    copies have no gap at all: loads that press them onto their contacts, or no load, make ties.
    """
    place, c = np.eye(int(rng.integers(2, 5))), step.contacts
    n_v = len(place) * step.n_v
    every = np.tile(np.arange(c.n_c), len(place))
    touches = np.repeat(rng.choice([0.0, 1.0], len(place)), c.n_c)
    mu_v, spin = rng.choice([0.0, 0.3, 0.5], (2, len(every)))
    touching = repeated(
        c, every, J=np.kron(place, c.J.reshape(-1, step.n_v)).reshape(len(every), 4, n_v),
        phi=touches * rng.choice([0.0, 1e-4, -1e-5], len(every)), mu_v=mu_v, mu_omega=0.02 * spin,
    )  # fmt: skip
    named = replace(touching, name=tuple(f"{rng.integers(99)}/{j}" for j in range(len(every))))
    force = rng.choice([0.0, -1.0], n_v) * rng.random(n_v)
    return free_step(np.kron(place, step.M_u), force, named, step.h)


def classes(rng, step):
    """The step without what couples up to three classes of coordinates: these are its groups."""
    most = int(rng.integers(1, 4))
    of_a, of_u, of_contact = (
        rng.integers(most, size=size) for size in (step.n_a, step.n_u, step.contacts.n_c)
    )
    coupled = of_contact[:, None, None] == np.concatenate([of_a, of_u])
    return step.replace(
        K_q=step.K_q * (of_a[:, None] == of_a),
        M_u=step.M_u * (of_u[:, None] == of_u),
        contacts=replace(step.contacts, J=step.contacts.J * coupled),
    )


def rows(rng, step):
    """Up to four rows of a user's own, in small integers, each on coordinates that H couples."""
    coupled = block_diag(step.K_q, step.M_u) != 0
    A = coupled[rng.integers(step.n_v, size=rng.integers(5))] * rng.integers(-1, 2, step.n_v)
    names = tuple(f"own {i}" for i in range(len(A)))
    return step.replace(extra=Extra(names, A, rng.choice([-1e-3, -1e-4, 0.0, 1e-5], len(A))))


def smaller(step, factor):
    """Loads, targets, gaps and sides of rows times one power of two."""
    c, extra = step.contacts, step.extra
    return step.replace(
        contacts=replace(c, phi=factor * c.phi),
        extra=Extra(extra.names, extra.A, factor * extra.b),
        **{name: factor * getattr(step, name) for name in LOADS},
    )


def powers(rng, step):
    """Loads and gaps from 2^-300 to 2^300."""
    return smaller(step, 2.0 ** int(rng.choice([0, 0, 0, -30, 40, -300, 300])))


def subnormal(rng, step):
    """Loads and gaps that float64 keeps some bits of, or none."""
    return smaller(step, 2.0 ** -int(rng.integers(900, 1075)))


def wide(rng, step):
    """Numbers times powers of ten up to the root of the ends of float64."""
    return scales(rng, step, WIDE)


def scales(rng, step, most=SCALES):
    """Numbers times powers of ten, one to all of them."""
    n_a, n_v, c = step.n_a, step.n_v, step.contacts
    often = rng.choice([0.15, 0.5, 1.0])

    def scale(*shape):
        """Powers of ten, of shape `shape`, most of them 1."""
        exponents = rng.uniform(-most, most, shape) * (rng.random(shape) < often)
        return np.asarray(10.0 ** (exponents if rng.random() < 0.5 else exponents.round()))

    S = scale(n_v) if rng.random() < 0.3 else scale()  # one for each coordinate, or for all
    S = np.broadcast_to(S, n_v)
    contacts = replace(
        c, phi=c.phi * scale(c.n_c) * scale(),
        J=c.J * S * (scale(c.n_c)[:, None, None] if rng.random() < 0.3 else scale()),
        mu_v=np.minimum(c.mu_v * scale(c.n_c), 1e12), mu_omega=c.mu_omega * scale(),
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


def singular(rng, step):
    """Of each matrix the last pivot has 2e-14 of its diagonal entry."""
    K_q, M_u = (nearly_singular(rng, n, 2e-14) for n in (step.n_a, step.n_u))
    return step.replace(K_q=K_q, M_u=M_u)


TRAITS = {
    trait.__name__: trait
    for trait in (integers, copies, classes, rows, powers, subnormal, scales, wide, singular)
}


def nearly_singular(rng, n, share=None):
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
        unit = 10.0 ** rng.uniform(-150, 150, n) if rng.random() < 0.5 else np.full(n, 2.0**-520)
        S = S * unit * unit[:, None]
    return np.tril(S) + np.tril(S, -1).T
