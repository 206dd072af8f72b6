"""Whether the contacts of a step, or of a state at rest, can bear its loads: a linear program.

A force in a contact's cone is a combination, with multipliers lam >= 0, of the cone's rows a_i, so
that the generalised force of all contacts on the un-actuated coordinates is A_u' lam. The step is
in equilibrium if A_u' lam + tau_u = 0 for some lam. Where no lam does it, what is missing is the
least r with A_u' lam + tau_u + r = 0, in the sum of sizes of L^-1 r, M_u = L L'.

It agrees with the slow step (:mod:`~quasistatic_ref.optional.doctor.slow`) where all sticks, and
says of a guide what that cannot: whether a body is borne without a squeeze.
"""

from functools import cache

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.optional.doctor.undecided import optimum
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.tolerances import SAME_NORMAL

AROUND = 72
"""Directions of friction that stand for the circle of a curved cone [-]."""
CHEAP = 1e-6
"""Cost of a normal force over that of as much that is missing [-]."""
TINY = 1e-300
"""Of a coordinate that no contact moves."""
TORSIONS = np.linspace(-0.5, 0.5, 13) * np.pi
"""Latitudes at which they stand, from torsion alone to torsion alone [rad]."""


def bearing(step: StepData, touching: Mask, at_most: Array | float = np.inf) -> tuple[Array, Array]:
    """What the contacts of a step cannot bear of its loads on the un-actuated coordinates, and how.

    Forces lie in the cones of the touching contacts. Lever arms count, since a row of A holds them.

    Parameters
    ----------
    step : StepData
        In any cone.
    touching : ndarray of bool, shape (n_c,)
    at_most : ndarray, shape (n_c,), or float
        Largest normal force of each contact [N]; infinite where nothing limits it.

    Returns
    -------
    missing : ndarray, shape (n_u,)
        [N, N m], zero if the load is borne.
    normal : ndarray, shape (n_c,)
        Normal forces [N] with the least sum that bear the rest.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> lacks, _ = bearing(step, np.array([True]))
    >>> bool(np.abs(lacks).sum() > 0)  # it spins: its torque is beyond mu_omega m g
    True
    """
    from scipy.optimize import linprog  # takes as long as a short run

    n_u = step.n_u
    if not n_u:
        return np.zeros(0), np.zeros(step.contacts.n_c)
    rows, contact = _cone_rows(step, touching)
    root = np.linalg.cholesky(step.M_u)  # of a free body forces, and torques about its centre
    along = np.linalg.solve(root, np.column_stack([rows[:, step.n_a :].T, step.tau_u]))
    load = along[:, -1]
    size = float(np.abs(load).max(initial=0.0)) or 1.0
    of_contact = np.equal.outer(np.arange(step.contacts.n_c), contact)  # it pushes by 1 along n
    pressing = np.hstack([of_contact, np.zeros((step.contacts.n_c, 2 * n_u))])
    at_most = np.broadcast_to(at_most, touching.shape)
    limited = np.isfinite(at_most) & touching
    answer = linprog(
        np.concatenate([np.full(len(rows), CHEAP), np.ones(2 * n_u)]),
        A_ub=pressing[limited],
        b_ub=at_most[limited] / size,
        A_eq=np.column_stack([along[:, :-1], np.eye(n_u), -np.eye(n_u)]),
        b_eq=-load / size,
    )
    x = optimum(answer)
    plus, minus = x[len(rows) :].reshape(2, n_u)
    return np.asarray(size * (root @ (plus - minus))), np.asarray(size * (pressing @ x))


def unsqueezed(step: StepData, touching: Mask) -> Array:
    """Normal forces, shape (n_c,) [N], that bear the loads of a step and are no mere squeeze.

    A squeeze, of forces in the cones with A_u' w = 0, moves nothing. In a rigid guide it may have
    any size, so that friction would bear any load: no force is taken to have made it.

    Parameters
    ----------
    step : StepData
    touching : ndarray of bool, shape (n_c,)
    """
    from scipy.optimize import linprog  # takes as long as a short run

    _, normal = bearing(step, touching)
    presses = normal > CHEAP * normal.max(initial=0.0)
    if not presses.any():
        return np.zeros_like(normal)
    rows, contact = _cone_rows(step, presses)
    along = rows[:, step.n_a :]
    along = along / np.abs(along).max(axis=0, initial=TINY)
    size = float(normal.max())
    of_contact = np.equal.outer(np.arange(len(normal)), contact)
    answer = linprog(
        np.full(len(rows), -1.0),
        A_ub=np.vstack([along.T, -along.T, of_contact]),
        b_ub=np.concatenate([np.full(2 * step.n_u, SAME_NORMAL), normal / size]),
    )
    return np.asarray(normal - size * (of_contact @ optimum(answer)))


def _cone_rows(step: StepData, touching: Mask) -> tuple[Array, Array]:
    """Generators of the cones of touching contacts, (K, n_v), and the contact of each, (K,)."""
    contacts = step.contacts
    kind = cone(step.cone)
    matrix = kind.matrix if kind.polyhedral else _sphere()
    motion = np.stack(frame_jacobian(contacts, contacts.J), axis=1)  # (n_c, 4, n_v)
    every = np.einsum("ri,civ->crv", matrix, motion * scaled_by(contacts)[:, :, None])
    return every[touching].reshape(-1, step.n_v), np.repeat(np.flatnonzero(touching), len(matrix))


@cache
def _sphere() -> Array:
    """Rows (1, x), shape (R, 4), for points x over the unit sphere and around its equator.

    Friction without torsion is right to 0.1 %, and with it to 1 %.
    """
    up, around = np.meshgrid(TORSIONS, np.arange(AROUND) * (2 * np.pi / AROUND))
    outside = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])
    outside[:, up == 0] /= np.cos(np.pi / AROUND)
    return np.concatenate([np.ones((1, up.size)), outside.reshape(3, -1)]).T


def at_rest(start: Start, q: Array, contacts: Contacts) -> StepData:
    """A step whose targets are where its joints are, under the loads of t = 0.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (n_q,)
    contacts : Contacts
        At q.
    """
    load = start.simulator.generalised_force(q, 0.0)
    return start.simulator.step_under(q, q[: start.system.n_q_a], load, contacts)


def borne(start: Start, step: StepData, name: str, squeezed: bool = True) -> bool:
    """Whether forces in the cones of touching contacts bear a body's weight.

    Lever arms count. A force below 1e-3 of the body's weight counts as none.

    Parameters
    ----------
    start : Start
    step : StepData
        Of :func:`at_rest`.
    name : str
        Of a free body.
    squeezed : bool
        Whether contacts may squeeze the body: by a squeeze of any size a guide bears any load.
        Otherwise they press by what bears the load and no more.
    """
    touching = start.touching(step.contacts.phi)
    at_most = np.inf if squeezed else unsqueezed(step, touching)
    missing, _ = bearing(step, touching, at_most)
    base = start.free_bases[name].v
    lacks = float(np.linalg.norm(missing[base.start - step.n_a : base.stop - step.n_a]))
    return lacks <= LIGHT * start.system.mass(name) * start.g
