"""The contacts that MuJoCo finds, as contacts of a step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.still import Still
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import DEEP, FULL_RANK

USED_OR_IN_GAP = (0, 1)
"""Values of ``exclude`` of contacts that a step has."""


def found(state: Still) -> list[Any]:
    """MuJoCo's contacts, without those between bodies that do not move."""
    if state.disables("CONSTRAINT"):
        return []
    return [touch for touch in state.data.contact if touch.exclude in USED_OR_IN_GAP]


def rubs(state: Still) -> bool:
    """Whether a contact has friction; without it, all cones are the same."""
    return any(touch.dim > 1 for touch in found(state))


def gap(touch: Any) -> float:
    """The signed distance at which MuJoCo lets a contact push [m]."""
    return float(touch.dist - touch.includemargin)


def name(state: Still, i: int, touch: Any) -> str:
    """A contact by the names of its geoms, or of the bodies of those that have none."""
    model = state.model
    number = state.mujoco.mjtObj.mjOBJ_GEOM
    geoms = (state.mujoco.mj_id2name(model, number, g) or state.words("body", model.geom_bodyid[g])
             for g in touch.geom)  # fmt: skip
    return f"{i}: {'/'.join(geoms)}"


def contacts(state: Still, T: Array, as_is: bool) -> Contacts:
    """The contacts of a state; gaps below zero count as zero unless `as_is`.

    Parameters
    ----------
    state : Still
    T : ndarray, shape (nv, n)
        MuJoCo's displacement, per unit of the coordinates of the step [-].
    as_is : bool

    Raises
    ------
    ModelError
        Naming a contact whose friction differs in its two directions.
    """
    touches = found(state)
    frames = np.array([touch.frame.reshape(3, 3) for touch in touches]).reshape(-1, 3, 3)
    friction = np.array([touch.friction for touch in touches]).reshape(-1, 5)
    condim = np.array([touch.dim for touch in touches], dtype=np.int64)
    phi = np.array([gap(touch) for touch in touches])
    names = tuple(name(state, i, touch) for i, touch in enumerate(touches))
    for called, mu, dim in zip(names, friction, condim, strict=True):
        if dim > 1 and mu[0] != mu[1]:
            problem = "differs in its two directions, for which there is no cone; use one for both"
            raise ModelError(problem, field=f"contact[{called}].friction", value=mu[:2].tolist())
    J = [jacobian(state, touch) @ T for touch in touches]
    return Contacts(
        name=names,
        phi=phi if as_is else np.maximum(phi, 0.0),
        n=frames[:, 0],
        d1=frames[:, 1],
        d2=frames[:, 2],
        J=np.array(J).reshape(-1, 4, T.shape[1]),
        mu_v=np.where(condim > 1, friction[:, 0], 0.0),
        mu_omega=np.where(condim > 3, friction[:, 2], 0.0),
        rows=np.where(condim > 3, 6, 4),
    )


def jacobian(state: Still, touch: Any) -> Array:
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


def words(state: Still) -> Iterator[str]:
    """What a step leaves out of contacts."""
    for i, touch in enumerate(found(state)):
        if touch.dim == 6:
            yield f"contact[{name(state, i, touch)}]: rolling friction, for which there is no row"


def deep(state: Still, step: StepData) -> Iterator[str]:
    """Contacts that are deep, and what keeps them there."""
    of_equalities = ["equality" in called for called in step.extra.names]
    tied = np.abs(step.extra.A[np.array(of_equalities, dtype=bool)]).max(axis=0, initial=0.0)
    contacts = step.contacts
    along_n = np.einsum("jci,jc->ji", contacts.J[:, :3], contacts.n)
    for touch, called, J_n in zip(found(state), contacts.name, along_n, strict=True):
        if gap(touch) >= -DEEP:
            continue
        row = np.flatnonzero(np.abs(J_n) > FULL_RANK)
        reason = "nothing: MuJoCo pushes them apart as soon as it runs"
        if tied[row].any():
            reason = "an equality may"
        if (row < step.n_a).any():
            reason = "a servo or spring may"
        if not row.size:
            reason = "their joints leave no way out"
        by = f"its bodies penetrate by {-1e3 * gap(touch):.3g} mm"
        yield f"contact[{called}]: {by}; what keeps them there: {reason}"
