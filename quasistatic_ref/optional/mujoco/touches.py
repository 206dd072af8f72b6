"""The contacts that MuJoCo finds, and as a step has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState, Natural
from quasistatic_ref.optional.mujoco.tolerances import DEEP
from quasistatic_ref.step.contacts import Contacts

if TYPE_CHECKING:
    from mujoco import MjContact, MjData

USED_OR_IN_GAP = (0, 1)
"""Values of ``exclude`` of contacts that a step has."""
ROLLS = "rolling friction, for which there is no row"
HELD = "left out: joints or equalities hold its bodies along the normal, and bear any force there"


class StateContact(NamedTuple):
    """A contact of a state: one point of two geoms.

    Parameters
    ----------
    name : str
    pair : str
        What touches, as of all contacts of the two geoms.
    bodies : tuple of str
        Alpha's and beta's; ``"world"`` for what cannot move.
    phi : float
        The gap at which MuJoCo lets it push, the distance less its margin [m].
    distance : float
        Of the geoms, below 0 where they overlap [m].
    closed : bool
        Whether its gap counts as zero, unless gaps are taken as they are.
    frame : ndarray, shape (3, 3)
        n, d1, d2 [-].
    J : ndarray, shape (4, nv)
        Of Eq. :eq:`eq-3`, along MuJoCo's velocities.
    mu_v, mu_omega : float
        [-, m].
    rows : int
    rolls : bool
        Whether it has rolling friction, too, which a step has not.
    """

    name: str
    pair: str
    bodies: tuple[str, str]
    phi: float
    distance: float
    closed: bool
    frame: Array
    J: Array
    mu_v: float
    mu_omega: float
    rows: int
    rolls: bool

    def slip(self, v: Array) -> float:
        """Speed of one surface along the other at a velocity v, (nv,) [m/s]."""
        return float(np.linalg.norm(self.frame[1:] @ (self.J @ v)[:3]))

    def spin(self, v: Array) -> float:
        """Rate about the normal at a velocity v, (nv,) [rad/s]."""
        return float(abs(self.J[3] @ v))


def numbers(state: MujocoState) -> list[int]:
    """Which of MuJoCo's contacts, by number, are between bodies of which one can move."""
    if state.disables("CONSTRAINT"):
        return []
    return [i for i, touch in enumerate(state.data.contact) if touch.exclude in USED_OR_IN_GAP]


def contacts(state: MujocoState) -> list[StateContact]:
    """MuJoCo's contacts between bodies of which at least one can move.

    A name has MuJoCo's number, and the geoms, or the bodies of geoms without names. The gap is that
    at which MuJoCo lets a contact push. A gap of up to ``DEEP`` of a contact with adhesion counts
    as closed: MuJoCo lets such a contact rest a little off the surface. So does one of geoms that
    hop.

    Raises
    ------
    ModelError
        Naming a contact whose friction differs in its two directions.
    """
    every = []
    for i in numbers(state):
        touch = state.data.contact[i]
        pair = "/".join(
            state.name("geom", g) or state.words("body", state.model.geom_bodyid[g])
            for g in touch.geom
        )
        name = f"{i}: {pair}"
        phi = float(touch.dist - touch.includemargin)
        sticks = touch.adhesion > 0 and phi <= DEEP
        hops = tuple(touch.geom.tolist()) in state.hops
        frame = touch.frame.reshape(3, 3).copy()
        bodies = (mover_name(state, touch.geom[0]), mover_name(state, touch.geom[1]))
        every.append(
            StateContact(name, pair, bodies, phi, float(touch.dist), phi <= 0 or sticks or hops,
                         frame,
                         jacobian(state, touch), *friction(touch, name), touch.dim == 6)
        )  # fmt: skip
    return every


def mover_name(state: MujocoState, geom: int) -> str:
    """The name of the body that a geom moves with; ``"world"`` if none."""
    body = state.model.body_weldid[state.model.geom_bodyid[geom]]
    return state.called("body", body) if body else "world"


def held(every: Sequence[StateContact], scale: Natural, basis: Array) -> Mask:
    """The contacts whose bodies joints and equalities hold along the normal, shape (n_c,).

    Only rounding is left of their normal rows: they bear any force, and friction has no bound.

    Parameters
    ----------
    every : sequence of StateContact
    scale : Natural
        Of the coordinates of the step.
    basis : ndarray, shape (r, n)
        Of the equalities [-], as of ``constraints.Held``.
    """
    rows = [contact.frame[0] @ contact.J[:3] for contact in every]
    return scale.empty(np.array(rows).reshape(-1, len(scale.T)), basis)


def friction(touch: MjContact, name: str) -> tuple[float, float, int]:
    """mu_v [-], mu_omega [m] and rows of a contact.

    Raises
    ------
    ModelError
        Naming it, if its friction differs in its two directions.
    """
    if touch.dim == 1:
        return 0.0, 0.0, 4
    mu = touch.friction.tolist()
    if mu[0] != mu[1]:
        problem = "differs in its two directions, for which there is no cone; use one for both"
        raise ModelError(problem, field=f"contact[{name}].friction", value=mu[:2])
    return (mu[0], mu[2], 6) if touch.dim > 3 else (mu[0], 0.0, 4)


def jacobian(state: MujocoState, touch: MjContact) -> Array:
    """J of Eq. :eq:`eq-3` along MuJoCo's velocities, shape (4, nv), world frame.

    MuJoCo has one point, midway between the surfaces; the material points are one on either.
    """
    model = state.model
    n = touch.frame[:3]
    J = np.zeros((4, model.nv))
    for geom, side in zip(touch.geom, (-1.0, 1.0), strict=True):
        point = touch.pos + side * touch.dist / 2 * n
        linear, angular = state.jacobian(point, model.geom_bodyid[geom])
        J[:3] += side * linear
        J[3] += side * (n @ angular)
    return J


def forces(
    state: MujocoState, data: MjData, means: Mapping[tuple[int, int], Array] | None = None
) -> Array:
    """MuJoCo's (f_d1, f_d2, f_n, tau_n, tau_d1, tau_d2) in a state, (n_c, 6) [N, N m].

    Of each contact; the last two are of rolling friction, which a step has not. Forces include
    what balances adhesion, which MuJoCo takes off them. Contacts of a pair of geoms in `means`
    share its mean, the force on the second geom [N] and the torque [N m], (4,).
    """
    its = np.zeros((data.ncon, 6))
    for i in range(data.ncon):
        state.mujoco.mj_contactForce(state.model, data, i, its[i])
    its[:, 0] += data.contact.adhesion
    pairs = [tuple(touch.geom.tolist()) for touch in data.contact]
    for pair, mean in (means or {}).items():
        at = [i for i, geoms in enumerate(pairs) if geoms == pair]
        for i in at:
            frame = data.contact[i].frame.reshape(3, 3)
            its[i, :4] = [*(frame @ mean[:3]), mean[3]]
            its[i] /= len(at)
    return its[numbers(state)][:, [1, 2, 0, 3, 4, 5]]


def step_contacts(every: Sequence[StateContact], T: Array, as_is: bool) -> Contacts:
    """Contacts in a step's coordinates, from which T, (nv, n_v), makes MuJoCo's velocities [-]."""
    frames = np.reshape([contact.frame for contact in every], (-1, 3, 3))
    return Contacts(
        name=[contact.name for contact in every],
        phi=[0.0 if contact.closed and not as_is else contact.phi for contact in every],
        n=frames[:, 0],
        d1=frames[:, 1],
        d2=frames[:, 2],
        J=np.reshape([contact.J for contact in every], (-1, 4, len(T))) @ T,
        mu_v=[contact.mu_v for contact in every],
        mu_omega=[contact.mu_omega for contact in every],
        rows=[contact.rows for contact in every],
    )


def quasi_dynamic_number(
    every: Sequence[StateContact], v: Array, gravity: Array, h: float
) -> float:
    """Largest v / (mu_v g h) of closed contacts, v the speed at which one slides [-].

    Parameters
    ----------
    every : sequence of StateContact
    v : ndarray, shape (nv,)
        MuJoCo's velocity.
    gravity : ndarray, shape (3,)
    h : float
    """
    rubbing = [contact for contact in every if contact.closed and contact.mu_v]
    fastest = max((contact.slip(v) / contact.mu_v for contact in rubbing), default=0.0)
    g = float(np.linalg.norm(gravity))
    if not fastest:
        return 0.0
    return fastest / (g * h) if g else np.inf
