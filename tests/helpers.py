"""Steps of tests, their rows by hand, and the one definition of error."""

import os
from dataclasses import replace
from itertools import pairwise

import numpy as np

from quasistatic_ref import (
    InputError,
    load_solution,
    load_step,
    optimality_residuals,
    standard_form,
    verify,
)
from quasistatic_ref.step.cones import cone
from tests.made import (
    Z,
    contacts_of,
    frames_about,
    free_step,
    pinch_step,
    point_step,
    random_contacts,
    sphere_step,
    step_on,
)

REQUIRED = ("clarabel", "osqp", "piqp", "daqp")
PAPER = 7, 6, (6,) * 10 + (4,) * 5
"""n_a, n_u and rows of each contact, of the paper's grasp."""
SHAPES = [
    PAPER,
    (3, 4, (6, 4)),
    (0, 6, (4, 6, 4)),
    (4, 0, (6, 6)),
    (2, 2, ()),
]
"""The same of random steps."""
EAST = [1.0, 0.0, 0.0]
NORTH = [0.0, 1.0, 0.0]
WEST = [-1.0, 0.0, 0.0]
"""Normals of walls."""


def changed(contacts, **changes):
    """A copy of contacts with some fields changed, checked as any other."""
    return replace(contacts, **changes)


def with_mu_of(other, step):
    """The step with another's mu_v and mu_omega, which are constants of a compiled problem."""
    mu = {name: getattr(other.contacts, name) for name in ("mu_v", "mu_omega")}
    return step.replace(contacts=changed(step.contacts, **mu))


def residuals_of(step, delta_q, lam):
    """The residuals of an answer in the step's own cone."""
    judge = cone(step.cone).judge(step.contacts.mu)
    return optimality_residuals(standard_form(step), delta_q, lam, judge)


def results_of(scenario, simulator=None):
    """The results of the steps of a scenario, which some simulator takes, one after the other."""
    simulator = simulator or scenario.simulator()
    q = scenario.system.q_start
    force = scenario.force or (lambda t, q: None)
    for k in range(scenario.steps):
        t = scenario.h * (k + 1)
        result = simulator.step(q, scenario.targets(t), force(t, q))
        q = result.q
        yield result


def first_step(scenario, simulator=None):
    """The first of them."""
    return next(results_of(scenario, simulator))


def random_step(rng, n_a=3, n_u=4, rows=(6, 4, 6)):
    """A random step with phi >= 0, which is always feasible: standing still is allowed.

    ``rng`` is a generator, or the seed of one.
    """
    rng = np.random.default_rng(rng)
    n_c = len(rows)
    contacts = random_contacts(
        rng, n_c, n_a + n_u,
        phi=1e-4 * np.abs(rng.normal(size=n_c)), mu_omega=rng.uniform(0.01, 0.1, n_c), rows=rows,
    )  # fmt: skip
    return step_on(rng, n_a, n_u, contacts)


def contact_row(contacts, j, i):
    """[J'(n~ + d~_i)]' of contact j by hand, i = 0 .. 5."""
    d1, d2 = contacts.d1[j], contacts.d2[j]
    along = (d1, d2, -d1, -d2, 0, 0)[i]
    spin = (0, 0, 0, 0, 1, -1)[i]
    point = contacts.n[j] + contacts.mu_v[j] * along
    return np.append(point, contacts.mu_omega[j] * spin) @ contacts.J[j]


def rows_by_hand(step):
    """[J'(n~ + d~_i)]' of every row by hand, contact-major, shape (m, n_v)."""
    c = step.contacts
    rows = [contact_row(c, j, i) for j, count in enumerate(c.rows) for i in range(count)]
    return np.reshape(rows, (-1, step.n_v))


def slacks(step, delta_q):
    """Phi + [J'(n~ + d~_i)]' delta_q of every row by hand, contact-major."""
    return np.repeat(step.contacts.phi, step.contacts.rows) + rows_by_hand(step) @ delta_q


def planted_step(rng, n_a=3, n_u=4, rows=(6, 4, 6)):
    """A step made around its own optimum: the step, delta_q and lam.

    One row of each contact is made active and given a positive multiplier; the forces are those
    that balance it. H is positive definite, so this optimum is the only one.
    """
    rng = np.random.default_rng(rng)
    step = random_step(rng, n_a, n_u, rows)
    delta_q = 1e-3 * rng.normal(size=step.n_v)
    J = rows_by_hand(step)
    motion = J @ delta_q
    lam = np.zeros(len(J))
    active = [
        start + int(np.argmin(motion[start:end])) for start, end in pairwise(step.offsets.tolist())
    ]
    lam[active] = rng.uniform(0.005, 0.015, len(active))
    spring = step.K_q @ (delta_q[:n_a] - step.delta_q_bar_a)
    push = lam @ J / step.h
    step = step.replace(
        tau_a=spring - push[:n_a],
        tau_u=step.M_u @ delta_q[n_a:] / step.h**2 - push[n_a:],
        contacts=changed(step.contacts, phi=-motion[active]),
    )
    return step, delta_q, lam


def point_on_floor(m=0.3, mu_v=0.5, phi=0.0, force=(0.0, 0.0, 0.0), h=0.01):
    """A point mass above a floor z = 0; delta_q is its displacement."""
    return point_step(m, force, mu_v, phi, h)


def sphere_on_floor(
    m=0.3,
    inertia=2e-4,
    radius=0.04,
    mu_v=0.5,
    mu_omega=0.02,
    phi=0.0,
    wrench=(0.0,) * 6,
    h=0.01,
):
    """A sphere above a floor z = 0; delta_q is its twist at the centre, wrench its load."""
    return sphere_step(m, inertia, radius, wrench, mu_v=mu_v, mu_omega=mu_omega, phi=phi, h=h)


def boxes_step(count):
    """A step of boxes that are pushed over a floor, out of each other's reach."""
    from quasistatic_ref.lab.bench.scenes import boxes

    scene = boxes(count)
    return scene.simulator("off", True).step(scene.q, np.zeros(0), scene.force).step


def pinch(m=0.2, grip=20.0, offset=0.01, mu_v=0.5, mu_omega=0.02):
    """A bar held by two fingers on the axis x, `offset` [m] along y from its centre of mass."""
    return pinch_step(grip, offset, mu_v, mu_omega, m=m)


def error(step, delta_q, truth):
    """||x - x*||_H / ||H^-1 g||_H."""
    H, g, *_ = standard_form(step)
    gap = np.asarray(delta_q) - np.asarray(truth)
    return float(np.sqrt(gap @ H @ gap / (g @ np.linalg.solve(H, g))))


def verify_refusal(folder, step, solution):
    """Why the command `verify` refuses two texts, as files of a folder; None where it does not."""
    paths = folder / "step.json", folder / "solution.json"
    for path, text in zip(paths, (step, solution), strict=True):
        path.write_text(text)
    try:
        posed = load_step(paths[0])
        return verify(load_solution(paths[1], posed)).reason or None
    except InputError as error:
        return str(error)


def one_sentence(errors):
    """The one line on standard error, without the program's name."""
    lines = errors.splitlines()
    assert len(lines) == 1, errors
    assert lines[0].startswith("quasistatic-ref: ")
    assert "Traceback" not in errors
    return lines[0].removeprefix("quasistatic-ref: ")


def resting_point(tau_x=0.0, contacts=1):
    """A body that moves along x, y, z and turns about z, on a floor below it, J = I."""
    each = (contacts, 1, 1)
    at = contacts_of(0.0, np.tile(np.eye(3), each), np.tile(np.eye(4), each), 0.5, 0.25, rows=6)
    return free_step(np.eye(4), [tau_x, 0.0, -2.0, 0.0], at, 0.5)


def point_between_walls(normals, phi, force=(0.0, 0.0, 0.0)):
    """A point mass of 1 kg, free along x, y, z, between frictionless walls."""
    n = np.array(normals)
    J = np.tile(np.eye(4, 3), (len(n), 1, 1))
    return free_step(np.eye(3), force, contacts_of(phi, frames_about(n, -Z), J, 0.0), 0.01)


def two_bodies(normals, phi, force):
    """Two bodies of three coordinates and 1 kg: a wall at each side of the second, mu = 0."""
    J = np.zeros((len(normals), 4, 6))
    J[:, :3, 3:] = np.eye(3)
    frames = frames_about(np.array(normals), Z)
    M = np.kron(np.eye(2), np.eye(3) + 0.1)  # all three coordinates of a body are coupled
    return free_step(M, force, contacts_of(phi, frames, J, 0.0), 0.01)


class Place(os.PathLike):
    """A path that is no Path, as an entry of `os.scandir` is."""

    def __init__(self, path):
        self.path = path

    def __fspath__(self):
        return str(self.path)

    def __repr__(self):
        return "<Place>"
