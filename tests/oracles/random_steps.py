"""Random steps that may be anything: what the exact answer and its certificate are tried on.

Those that commands and the vectors draw are in ``lab/made_steps/at_random.py``.
"""

from dataclasses import replace

import numpy as np

from quasistatic_ref import Extra, StepData
from tests.made import contacts_of, free_step, random_frames, repeated, spread_matrix
from tests.oracles.grasp_steps import grasp_step

CONES = ("pyramid", "product", "facets-6", "facets-8", "frictionless")


def any_step(rng, n_a, n_u, n_c, mass_ratio=1.0):
    """Anything that a step may be: duplicated contacts, penetration, mu = 0, light on heavy.

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
    frames = random_frames(rng, n_c).swapaxes(1, 2)
    J = rng.standard_normal((n_c, 4, n_a + n_u))
    J *= rng.random((n_c, 1, n_a + n_u)) < 0.7  # some coordinates do not move a contact
    phi = rng.choice([0.0, 1e-3, -1e-4], n_c) * rng.random(n_c)
    mu_v = rng.choice([0.0, 0.5, 1.0], n_c) * rng.random(n_c)
    mu_omega = rng.choice([0.0, 0.01], n_c)
    same = np.arange(n_c)
    for j in range(1, n_c):
        if rng.random() < 0.3:
            same[j] = same[rng.integers(j)]
    return StepData(
        h=0.01,
        K_q=spread_matrix(rng, n_a, 1e3, mass_ratio),
        M_u=spread_matrix(rng, n_u, 1.0, mass_ratio),
        tau_a=rng.standard_normal(n_a),
        tau_u=rng.choice([0.0, 1.0]) * rng.standard_normal(n_u),
        delta_q_bar_a=1e-3 * rng.standard_normal(n_a),
        contacts=contacts_of(
            phi[same], frames[same], J[same], mu_v[same], mu_omega[same], rng.choice([4, 6], n_c)
        ),
    )


def mixed_step(seed):
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
    n_a = int(rng.integers(0, 7))
    n_u = int(rng.integers(0, 7))
    n_u += n_a + n_u == 0
    return any_step(rng, n_a, n_u, int(rng.integers(0, 8)), rng.choice([1.0, 1e4, 1e9]))


def equal_groups(rng):
    """Copies of one body with contacts, each with its own gaps, friction, loads, rows and names.

    H and the numbers of contacts are equal, so that `fast` shares what it keeps of the groups. Some
    copies have no gap at all: loads that press them onto their contacts, or no load, make ties.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    copies = int(rng.integers(2, 5))
    of_body = any_step(rng, 0, int(rng.integers(1, 4)), int(rng.integers(0, 4)))
    contacts = of_body.contacts
    n = of_body.n_v
    every = np.tile(np.arange(contacts.n_c), copies)
    J = np.concatenate([np.pad(contacts.J, ((0, 0), (0, 0), (n * b, n * (copies - b - 1))))
                        for b in range(copies)])  # fmt: skip
    touches = np.repeat(rng.choice([0.0, 1.0], copies), contacts.n_c)
    mu = rng.choice([0.0, 0.3, 0.5], (2, len(every)))
    touching = repeated(
        contacts, every, J=J, phi=touches * rng.choice([0.0, 1e-4, -1e-5], len(every)),
        mu_v=mu[0], mu_omega=0.02 * mu[1],
    )  # fmt: skip
    touching = replace(touching, name=tuple(f"{rng.integers(99)}/{j}" for j in range(len(every))))
    own = rng.integers(0, 3, copies)
    place = np.eye(copies)
    A = np.vstack([np.kron(place[b], rng.integers(-1, 2, (own[b], n))) for b in range(copies)])
    names = tuple(f"own {i}" for i in range(len(A)))
    return free_step(
        np.kron(place, of_body.M_u),
        rng.choice([0.0, -1.0], copies * n) * rng.random(copies * n), touching, of_body.h,
    ).replace(extra=Extra(names, A, rng.choice([0.0, -1e-4, 1e-5], len(A))))  # fmt: skip


def resting_step(rng):
    """A body on contacts in small integers: rows that depend on each other, and exact ties.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    StepData
    """
    n = int(rng.integers(1, 5))
    n_c = int(rng.integers(1, 5))
    axes = np.eye(3)[[2, 0, 1]]  # the normal is vertical
    J = rng.integers(-1, 2, (n_c, 4, n)).astype(np.float64)
    J[:, 2] = 1.0
    phi = rng.choice([0.0, 0.0, 0.125], n_c)
    mu_v = rng.choice([0.0, 0.5, 1.0], n_c)
    mu_omega = rng.choice([0.0, 0.25], n_c)
    frames = np.tile(axes, (n_c, 1, 1))
    return free_step(
        np.diag(rng.choice([1.0, 2.0, 8.0], n)), rng.integers(-2, 2, n).astype(np.float64),
        contacts_of(phi, frames, J, mu_v, mu_omega, rng.choice([4, 6], n_c)), 0.5,
    )  # fmt: skip


def designed_step(seed):
    """A small step of one of four families and five cones; loads and gaps from 2^-300 to 2^300.

    The families are :func:`any_step`, :func:`equal_groups`, :func:`resting_step`, and any step
    that is divided into groups, with rows of a user's own in each.

    Parameters
    ----------
    seed : int

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    rng = np.random.default_rng(seed)
    family = seed % 4
    if family == 1:
        step = equal_groups(rng)
    elif family == 2:
        step = resting_step(rng)
    else:
        sizes = rng.integers((0, 1, 0), (3, 4, 4)).tolist()
        step = any_step(rng, *sizes, rng.choice([1.0, 1e4, 1e9]))
    if family == 3:
        step = divided(rng, step, 2)
        own = int(rng.integers(0, 3))
        A = np.eye(step.n_v)[rng.integers(step.n_v, size=own)] * rng.choice([-1.0, 1.0], (own, 1))
        names = tuple(f"own {i}" for i in range(own))
        step = step.replace(extra=Extra(names, A, rng.choice([-1e-3, 0.0, 1e-4], own)))
    factor = 2.0 ** int(rng.choice([0, 0, 0, -30, 40, -300, 300]))
    contacts = step.contacts
    extra = step.extra
    return step.replace(
        tau_a=factor * step.tau_a,
        tau_u=factor * step.tau_u,
        delta_q_bar_a=factor * step.delta_q_bar_a,
        contacts=replace(contacts, phi=factor * contacts.phi),
        extra=Extra(extra.names, extra.A, factor * extra.b),
        cone=CONES[seed % len(CONES)],
    )


def divided(rng, step, classes):
    """The same step without what couples coordinates of different classes, drawn at random.

    Parameters
    ----------
    rng : Generator
    step : StepData
        Without rows of a user's own.
    classes : int
        How many; the step then has at least as many groups as there are classes with a coordinate.
    """
    of_a = rng.integers(classes, size=step.n_a)
    of_u = rng.integers(classes, size=step.n_u)
    contacts = step.contacts
    of_contact = rng.integers(classes, size=step.contacts.n_c)
    coupled = of_contact[:, None, None] == np.concatenate([of_a, of_u])
    return step.replace(
        K_q=step.K_q * (of_a[:, None] == of_a),
        M_u=step.M_u * (of_u[:, None] == of_u),
        contacts=repeated(contacts, range(contacts.n_c), J=contacts.J * coupled),
    )
