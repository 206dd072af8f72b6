"""Whether the contacts of a step can bear its loads: a linear program.

A force in a contact's cone is a combination, with multipliers lam >= 0, of the cone's rows a_i, so
that the generalised force of all contacts on the un-actuated coordinates is A_u' lam. The step is
in equilibrium if A_u' lam + tau_u = 0 for some lam. Where no lam does it, what is missing is the
least r, in the sum of its sizes, with A_u' lam + tau_u + r = 0.
"""

from functools import cache

import numpy as np

from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.friction import frame_jacobian

AROUND = 72
"""Directions of friction that stand for the circle of a curved cone [-]."""
TORSIONS = np.linspace(-0.5, 0.5, 13) * np.pi
"""Latitudes at which they stand, from torsion alone to torsion alone [rad]."""


def missing_force(step: StepData, touching: Mask, at_most: Array, masses: Array) -> Array:
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

    Returns
    -------
    ndarray, shape (n_u,)
        [N], zero if the loads are borne. Its entries are along axes in which the kinetic energy of
        a body is a sum of squares: of a free body first those of its translation, then torques
        about its centre of mass over its radii of gyration.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> borne = missing_force(step, np.array([True]), np.array([np.inf]), np.full(6, 0.3))
    >>> bool(np.abs(borne).sum() > 0)  # it spins: its torque is beyond mu_omega m g
    True
    """
    from scipy.optimize import linprog  # takes as long as a short run

    n_u = step.n_u
    rows, contact = _cone_rows(step, touching)
    root = np.linalg.cholesky(step.M_u)
    scale = np.sqrt(masses)
    along = np.linalg.solve(root, np.column_stack([rows[:, step.n_a :].T, step.tau_u]))
    along *= scale[:, None]
    load = along[:, -1]
    size = float(np.abs(load).max(initial=0.0))
    if not size:
        return np.zeros(n_u)
    pressing = np.zeros((step.contacts.n_c, len(rows) + 2 * n_u))
    pressing[contact, np.arange(len(rows))] = 1.0  # a row pushes by 1 along n
    limited = np.isfinite(at_most) & touching
    answer = linprog(
        np.concatenate([np.zeros(len(rows)), np.ones(2 * n_u)]),
        A_ub=pressing[limited],
        b_ub=at_most[limited] / size,
        A_eq=np.column_stack([along[:, :-1], np.eye(n_u), -np.eye(n_u)]),
        b_eq=-load / size,
    )
    if answer.x is None:  # with r it has a solution: only where HiGHS fails
        return np.zeros(n_u)
    plus, minus = answer.x[len(rows) :].reshape(2, n_u)
    return np.asarray(size * (plus - minus))


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
