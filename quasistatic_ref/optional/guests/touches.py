"""The contacts that MuJoCo finds, as contacts of a step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.mujoco_state import MujocoState, Natural
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.tolerances import DEEP

if TYPE_CHECKING:
    from mujoco import MjContact, MjData

USED_OR_IN_GAP = (0, 1)
"""Values of ``exclude`` of contacts that a step has."""
HELD = "left out: joints or equalities hold its bodies along the normal, and bear any force there"


def listed(state: MujocoState) -> list[tuple[str, MjContact]]:
    """MuJoCo's contacts with their names, without those between bodies that do not move.

    A name has MuJoCo's number of the contact, and its geoms, or the bodies of geoms without names.
    """
    if state.disables("CONSTRAINT"):
        return []
    kept = [(i, t) for i, t in enumerate(state.data.contact) if t.exclude in USED_OR_IN_GAP]
    return [(f"{i}: {geoms(state, touch)}", touch) for i, touch in kept]


def rubs(state: MujocoState) -> bool:
    """Whether a contact has friction; without it, all cones are the same."""
    return any(touch.dim > 1 for _, touch in listed(state))


def gap(touch: MjContact) -> float:
    """The signed distance at which MuJoCo lets a contact push [m]."""
    return float(touch.dist - touch.includemargin)


def geoms(state: MujocoState, touch: MjContact) -> str:
    """The geoms of a contact, or the bodies of those without names."""
    bodies = state.model.geom_bodyid
    named = (state.name("geom", g) or state.words("body", bodies[g]) for g in touch.geom)
    return "/".join(named)


def contacts(
    state: MujocoState, scale: Natural, basis: Array, as_is: bool
) -> tuple[Contacts, tuple[str, ...]]:
    """The contacts of a state; gaps below zero count as zero unless `as_is`.

    So do gaps of up to ``DEEP`` of a contact with adhesion: MuJoCo lets such a contact rest a
    little off the surface.

    A contact is left out where only rounding is left of its normal row: where its joints and the
    equalities hold its bodies along the normal, they bear any force, and its friction has no bound.

    Parameters
    ----------
    state : MujocoState
    scale : Natural
        Of the coordinates of the step.
    basis : ndarray, shape (r, n)
        Of the equalities [-], as of ``constraints.Held``.
    as_is : bool

    Returns
    -------
    Contacts
    tuple of str
        What is left out.

    Raises
    ------
    ModelError
        Naming a contact whose friction differs in its two directions.
    """
    every = listed(state)
    J = np.array([jacobian(state, touch) for _, touch in every]).reshape(-1, 4, len(scale.T))
    n = np.array([touch.frame[:3] for _, touch in every]).reshape(-1, 3)
    empty = scale.empty(np.einsum("jc,jci->ji", n, J[:, :3]), basis)
    left_out = [f"contact[{every[k][0]}]: {HELD}" for k in np.flatnonzero(empty)]
    kept = np.flatnonzero(~empty)
    names = tuple(every[k][0] for k in kept)
    touches = [every[k][1] for k in kept]
    frames = np.array([touch.frame.reshape(3, 3) for touch in touches]).reshape(-1, 3, 3)
    phi = np.array([gap(touch) for touch in touches])
    sticks = np.array([touch.adhesion > 0 for touch in touches], dtype=bool) & (phi <= DEEP)
    rubs = [friction(touch, name) for name, touch in zip(names, touches, strict=True)]
    mu_v, mu_omega, rows = np.array(rubs).reshape(-1, 3).T
    at_rest = Contacts(
        name=names,
        phi=phi if as_is else np.where(sticks, 0.0, np.maximum(phi, 0.0)),
        n=frames[:, 0],
        d1=frames[:, 1],
        d2=frames[:, 2],
        J=J[kept] @ scale.T,
        mu_v=mu_v,
        mu_omega=mu_omega,
        rows=rows.astype(np.int64),
    )
    return at_rest, tuple(left_out)


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
        linear = np.zeros((3, model.nv))
        angular = np.zeros((3, model.nv))
        point = touch.pos + side * touch.dist / 2 * n
        body = model.geom_bodyid[geom]
        state.mujoco.mj_jac(model, state.data, linear, angular, point, body)
        J[:3] += side * linear
        J[3] += side * (n @ angular)
    return J


def words(state: MujocoState) -> Iterator[str]:
    """What a step leaves out of contacts."""
    for called, touch in listed(state):
        if touch.dim == 6:
            yield f"contact[{called}]: rolling friction, for which there is no row"
        if gap(touch) < -DEEP:
            yield f"contact[{called}]: its bodies penetrate by {-1e3 * gap(touch):.3g} mm"


def forces(state: MujocoState, data: MjData) -> Array:
    """MuJoCo's own (f_d1, f_d2, f_n, tau_n) of all its contacts in a state, (ncon, 4) [N, N m].

    They include what balances adhesion, which MuJoCo takes off them.
    """
    its = np.zeros((data.ncon, 6))
    for i in range(data.ncon):
        state.mujoco.mj_contactForce(state.model, data, i, its[i])
    its[:, 0] += data.contact.adhesion
    return its[:, [1, 2, 0, 3]]


def number(called: str) -> int:
    """MuJoCo's number of a contact, by its name."""
    return int(called.partition(":")[0])
