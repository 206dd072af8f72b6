"""Whether the contacts of a step, or of a state at rest, can bear its loads: a linear program.

A force in a contact's cone is a combination, with multipliers lam >= 0, of the cone's rows a_i, so
that the generalised force of all contacts on the un-actuated coordinates is A_u' lam. The step is
in equilibrium if A_u' lam + tau_u = 0 for some lam. Where no lam does it, what is missing is the
least r, in the sum of its sizes, with A_u' lam + tau_u + r = 0: of a free body along the normals
that press on it, along the rest of its load, and across both.
"""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.start import FARTHEST, SHORT, Start, least, translations
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.tolerances import SAME_NORMAL

AROUND = 72
"""Directions of friction that stand for the circle of a curved cone [-]."""
CHEAP = 1e-6
"""Cost of a normal force over that of as much that is missing [-]."""
TINY = 1e-300
"""Of a coordinate that no contact moves."""
TORSIONS = np.linspace(-0.5, 0.5, 13) * np.pi
"""Latitudes at which they stand, from torsion alone to torsion alone [rad]."""


class Statics(NamedTuple):
    """Forces by which contacts bear a load, and what is missing.

    Parameters
    ----------
    missing : ndarray, shape (n_u,)
        [N], zero if the load is borne. Its entries are along axes in which the kinetic energy of a
        body is a sum of squares: of a free body first those of its translation, then torques about
        its centre of mass over its radii of gyration.
    normal : ndarray, shape (n_c,)
        Normal forces [N] with the least sum that bear the rest.
    """

    missing: Array
    normal: Array


def missing_force(
    step: StepData, touching: Mask, at_most: Array, masses: Array, free: Sequence[slice] = ()
) -> Array:
    """What the contacts of a step cannot bear of its loads on the un-actuated coordinates.

    Forces lie in the cones of the touching contacts. Lever arms count, since a row of A holds them.
    A contact of an actuated body presses with its normal force in the step at most.

    Parameters
    ----------
    step : StepData
        In any cone.
    touching : ndarray of bool, shape (n_c,)
    at_most : ndarray, shape (n_c,)
        Largest normal force of each contact [N]; infinite where no spring limits it.
    masses : ndarray, shape (n_u,)
        Of the body of each un-actuated coordinate [kg].
    free : sequence of slice
        Un-actuated coordinates that translate a free body, three each.

    Returns
    -------
    ndarray, shape (n_u,)
        [N], as in :class:`Statics`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> borne = missing_force(step, np.array([True]), np.array([np.inf]), np.full(6, 0.3))
    >>> bool(np.abs(borne).sum() > 0)  # it spins: its torque is beyond mu_omega m g
    True
    """
    return statics(step, touching, at_most, masses, free).missing


def statics(
    step: StepData, touching: Mask, at_most: Array, masses: Array, free: Sequence[slice] = ()
) -> Statics:
    """What :func:`missing_force` returns, and the least normal forces.

    Parameters
    ----------
    step : StepData
    touching : ndarray of bool, shape (n_c,)
    at_most : ndarray, shape (n_c,)
        [N].
    masses : ndarray, shape (n_u,)
        [kg].
    free : sequence of slice
    """
    from scipy.optimize import linprog  # takes as long as a short run

    n_u = step.n_u
    n_c = step.contacts.n_c
    rows, contact = _cone_rows(step, touching)
    root = np.linalg.cholesky(step.M_u)
    scale = np.sqrt(masses)
    along = np.linalg.solve(root, np.column_stack([rows[:, step.n_a :].T, step.tau_u]))
    along *= scale[:, None]
    J_n = frame_jacobian(step.contacts, step.contacts.J)[0][touching, step.n_a :]
    normals = scale * np.linalg.solve(root, J_n.T).T
    axes = [_axes(normals[:, body], along[body, -1]) for body in free]
    for body, axis in zip(free, axes, strict=True):
        along[body] = axis.T @ along[body]
    load = along[:, -1]
    size = float(np.abs(load).max(initial=0.0))
    if not size:
        return Statics(np.zeros(n_u), np.zeros(n_c))
    pressing = np.zeros((n_c, len(rows) + 2 * n_u))
    pressing[contact, np.arange(len(rows))] = 1.0  # a row pushes by 1 along n
    limited = np.isfinite(at_most) & touching
    answer = linprog(
        np.concatenate([np.full(len(rows), CHEAP), np.ones(2 * n_u)]),
        A_ub=pressing[limited],
        b_ub=at_most[limited] / size,
        A_eq=np.column_stack([along[:, :-1], np.eye(n_u), -np.eye(n_u)]),
        b_eq=-load / size,
    )
    if answer.x is None:  # with r it has a solution: only where HiGHS fails
        return Statics(np.zeros(n_u), np.zeros(n_c))
    plus, minus = answer.x[len(rows) :].reshape(2, n_u)
    missing = np.asarray(size * (plus - minus))
    for body, axis in zip(free, axes, strict=True):
        missing[body] = axis @ missing[body]
    return Statics(missing, np.asarray(size * (pressing @ answer.x)))


def _axes(normals: Array, load: Array) -> Array:
    """Orthonormal columns, shape (3, 3): along what presses, along the rest of a load, across."""
    presses = normals.sum(axis=0)
    if np.linalg.norm(presses) <= SAME_NORMAL * len(normals):  # from opposite sides
        presses = load
    return np.asarray(np.linalg.qr(np.column_stack([presses, load, np.eye(3)]))[0])


def unsqueezed(step: StepData, normal: Array) -> Array:
    """Normal forces, shape (n_c,) [N], less those by which contacts squeeze what is between them.

    A squeeze, of forces in the cones with A_u' w = 0, moves nothing. In a rigid guide it may have
    any size, so that friction would bear any load: no force is taken to have made it.

    Parameters
    ----------
    step : StepData
    normal : ndarray, shape (n_c,)
        [N].
    """
    from scipy.optimize import linprog  # takes as long as a short run

    presses = normal > CHEAP * normal.max(initial=0.0)
    if not presses.any():
        return np.zeros_like(normal)
    rows, contact = _cone_rows(step, presses)
    along = rows[:, step.n_a :]
    along = along / np.abs(along).max(axis=0, initial=TINY)
    size = float(normal.max())
    of_contact = np.zeros((len(normal), len(rows)))
    of_contact[contact, np.arange(len(rows))] = 1.0
    answer = linprog(
        np.full(len(rows), -1.0),
        A_ub=np.vstack([along.T, -along.T, of_contact]),
        b_ub=np.concatenate([np.full(2 * step.n_u, SAME_NORMAL), normal / size]),
    )
    return normal if answer.x is None else np.asarray(normal - size * (of_contact @ answer.x))


def _cone_rows(step: StepData, touching: Mask) -> tuple[Array, Array]:
    """Generators of the cones of touching contacts, (K, n_v), and the contact of each, (K,)."""
    contacts = step.contacts
    mu = contacts.mu  # (mu_v, mu_v, mu_omega), which is 0 where it is not used
    kind = cone(step.cone)
    matrix = kind.matrix if kind.polyhedral else _sphere()
    motion = np.stack(frame_jacobian(contacts, contacts.J), axis=1)  # (n_c, 4, n_v)
    motion[:, 1:] *= mu[:, :, None]
    every = np.einsum("ri,civ->crv", matrix, motion)
    return every[touching].reshape(-1, step.n_v), np.repeat(np.flatnonzero(touching), len(matrix))


@cache
def _sphere() -> Array:
    """(1, x), shape (R, 4), with points x on the unit sphere, and about it on its equator.

    Friction without torsion is right to 0.1 %, and with it to 1 %.
    """
    angles = np.arange(AROUND) * (2 * np.pi / AROUND)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    ways = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    ways += [[*np.cos(up) * x, np.sin(up)] for up in TORSIONS[1:-1] for x in circle]
    outside = np.array(ways)
    flat = outside[:, 2] == 0
    outside[flat] /= np.cos(np.pi / AROUND)
    return np.column_stack([np.ones(len(outside)), outside])


class AtRest(NamedTuple):
    """A step whose targets are where its joints are, and its contacts that touch.

    Parameters
    ----------
    step : StepData
    touching : ndarray of bool, shape (n_c,)
        A gap below 1e-6 of the smaller shape counts as none.
    bodies : tuple of str, length n_u
        The body of each un-actuated coordinate.
    masses : ndarray, shape (n_u,)
        Theirs [kg].
    free : list of slice
        Un-actuated coordinates that translate a free body.
    """

    step: StepData
    touching: Mask
    bodies: tuple[str, ...]
    masses: Array
    free: list[slice]

    def without_squeeze(self) -> Array:
        """Normal forces, shape (n_c,) [N], that bear the loads and are no mere squeeze."""
        no_limit = np.full(self.step.contacts.n_c, np.inf)
        normal = statics(self.step, self.touching, no_limit, self.masses, self.free).normal
        return unsqueezed(self.step, normal)


def at_rest(start: Start, q: Array, contacts: Contacts) -> AtRest:
    """A step whose targets are where its joints are, under the loads of t = 0.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (n_q,)
    contacts : Contacts
        At q.
    """
    system = start.system
    simulator = start.simulator
    load = simulator.generalised_force(q, 0.0)
    step = simulator.step_under(q, q[: system.n_q_a], load, contacts)
    names = tuple(c.joint.partition("/")[0] for c in system.coordinates[step.n_a :])
    sizes = np.repeat([least(pair) for pair in start.pairs], [pair.n_c for pair in start.pairs])
    touching = contacts.phi <= SHORT * np.minimum(sizes, FARTHEST)
    masses = np.array([system.mass(name) for name in names])
    return AtRest(step, touching, names, masses, translations(system))


def borne(start: Start, q: Array, contacts: Contacts, name: str, squeezed: bool = True) -> bool:
    """Whether forces in the cones of touching contacts bear a body's weight.

    Lever arms count. A force below 1e-3 of the body's weight counts as none.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (n_q,)
    contacts : Contacts
        At q.
    name : str
        Of a free body.
    squeezed : bool
        Whether contacts may squeeze the body: by a squeeze of any size a guide bears any load.
        Otherwise they press by what bears the load and no more.
    """
    rest = at_rest(start, q, contacts)
    at_most = np.full(contacts.n_c, np.inf) if squeezed else rest.without_squeeze()
    missing = missing_force(rest.step, rest.touching, at_most, rest.masses, rest.free)
    lacks = float(np.linalg.norm(missing[[x == name for x in rest.bodies]]))
    return lacks <= LIGHT * start.system.mass(name) * start.g
