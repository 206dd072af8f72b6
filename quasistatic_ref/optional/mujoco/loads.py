"""What drives a MuJoCo state: all forces on it, and which of them are springs of K_q.

A servo or passive spring of stiffness k acts along a length with gradient m. It adds k m m' to K_q,
and its force at the state to tau_k = K_q delta_q_bar, Eq. (1). All else is a constant force.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.fates import kind_of, named
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState


class Spring(NamedTuple):
    """A servo or passive spring: its field of the model, stiffness k [N/m, N m/rad], m (nv,)."""

    field: str
    k: float
    m: Array


@dataclass(frozen=True, eq=False)
class Loads:
    """The forces on a state at rest, along MuJoCo's velocities.

    Parameters
    ----------
    springs : tuple of Spring
    of_springs : ndarray, shape (nv,)
        Forces of all springs [N, N m].
    others : ndarray, shape (nv,)
        All other forces [N, N m] but those of contacts, limits, equalities and friction.
    left_out : tuple of str
        Sentences about what is held as it is.
    """

    springs: tuple[Spring, ...]
    of_springs: Array
    others: Array
    left_out: tuple[str, ...]


def diagonal_of_H(springs: Iterable[Spring], M: Array, h: float) -> Array:
    """Diagonal of H of all joints, shape (nv,), from M (nv, nv) and h [s]."""
    k = sum((spring.k * spring.m**2 for spring in springs), np.zeros(len(M)))
    return np.where(k > 0, h * k, np.diag(M) / h)


def loads(state: MujocoState) -> Loads:
    """The loads of a state.

    Raises
    ------
    ModelError
        Naming a servo or spring of negative stiffness.
    """
    model = state.model
    data = state.data
    springs = list(passive_springs(state))
    of_springs = data.qfrc_spring.copy()
    left_out = list(passive_words(state))
    moments = state.moments
    for i in range(model.nactuator):
        if disabled(state, i):
            continue
        left_out += actuator_words(state, i)
        servo = Spring(named(state, "actuator_biasprm", i), stiffness(state, i), moments[i])
        if servo.k and not saturated(state, i, servo.m):
            springs.append(servo)
            of_springs += data.actuator_force[i] * servo.m
    check_stiff(springs)
    others = data.qfrc_smooth - of_springs  # MuJoCo's sum of all forces, of gravity to xfrc_applied
    return Loads(tuple(springs), of_springs, others, tuple(left_out))


def check_stiff(springs: Iterable[Spring]) -> None:
    """Refuse servos and springs of negative stiffness: ModelError, naming one."""
    for spring in springs:
        if spring.k < 0:
            problem = "pushes away from its target; make its stiffness positive"
            raise ModelError(problem, field=spring.field, value=spring.k)


def passive_springs(state: MujocoState) -> Iterator[Spring]:
    """The springs of joints and of tendons that are taut."""
    model = state.model
    if state.disables("SPRING"):
        return
    axes = np.eye(model.nv)
    for dof, j in enumerate(model.dof_jntid):
        if k := float(model.jnt_stiffness[j]):
            yield Spring(named(state, "jnt_stiffness", j), k, axes[dof])
    for i, m in enumerate(state.tendons):
        k = float(model.tendon_stiffness[i])
        if k and not slack(state, i):
            yield Spring(named(state, "tendon_stiffness", i), k, m)


def slack(state: MujocoState, i: int) -> bool:
    """Whether a tendon's spring is within the range of lengths in which it does not pull."""
    shortest, longest = state.model.tendon_lengthspring[i]
    return bool(shortest < state.data.ten_length[i] < longest)


def passive_words(state: MujocoState) -> Iterator[str]:
    """What a step leaves out of passive springs."""
    model = state.model
    if state.disables("SPRING"):
        return
    for j in np.flatnonzero(model.jnt_stiffness).tolist():
        first = model.jnt_dofadr[j]
        where = named(state, "jnt_stiffness", j)
        yield f"{where}: its coordinates are actuated, so that their mass has no part in the step"
        turns = {"BALL": slice(first, first + 3), "FREE": slice(first + 3, first + 6)}
        turned = turns.get(kind_of(state, "jnt_type", j))
        if turned is not None and state.data.qfrc_spring[turned].any():
            yield f"{where}: its stiffness is that of a small rotation"
    for i in np.flatnonzero(model.tendon_stiffness).tolist():
        if slack(state, i):
            yield f"{named(state, 'tendon_stiffness', i)}: its spring is slack, and stays so"


def disabled(state: MujocoState, i: int) -> bool:
    """Whether the model switches an actuator off."""
    group = 1 << int(state.model.actuator_group[i])
    return state.disables("ACTUATION") or bool(state.model.opt.disableactuator & group)


def stiffness(state: MujocoState, i: int) -> float:
    """How much an actuator's force falls per unit of its length [N/m, N m/rad]."""
    affine = kind_of(state, "actuator_biastype", i) == "AFFINE"
    return -float(state.model.actuator_biasprm[i, 1]) if affine else 0.0


def saturated(state: MujocoState, i: int, m: Array) -> bool:
    """Whether an actuator's force is at a limit of the actuator, its joint or its tendon."""
    model = state.model
    data = state.data
    j = model.actuator_trnid[i, 0]
    full = model.actuator_forcelimited[i] and _at_end(
        data.actuator_force[i], model.actuator_forcerange[i]
    )
    if kind_of(state, "actuator_trntype", i) == "TENDON" and model.tendon_actfrclimited[j]:
        pulls = model.actuator_trntype == model.actuator_trntype[i]
        total = data.actuator_force[: len(pulls)][pulls & (model.actuator_trnid[:, 0] == j)].sum()
        full |= _at_end(total, model.tendon_actfrcrange[j])
    for dof in np.flatnonzero(m).tolist():
        of = model.dof_jntid[dof]
        if model.jnt_actfrclimited[of]:
            full |= _at_end(data.qfrc_actuator[dof], model.jnt_actfrcrange[of])
    return bool(full)


def _at_end(force: float, ends: Array) -> bool:
    return not ends[0] < force < ends[1]


def actuator_words(state: MujocoState, i: int) -> Iterator[str]:
    """What a step leaves out of an actuator."""
    model = state.model
    data = state.data
    where = state.words("actuator", i)
    if kind_of(state, "actuator_gaintype", i) == "MUSCLE":
        yield f"{where}: its force stays as it is, whatever its length"
    first = model.actuator_actadr[i]
    if first >= 0 and data.act_dot[first : first + model.actuator_actnum[i]].any():
        yield f"{where}: its activation still changes, and stays as it is"
    if not stiffness(state, i) and model.actuator_biasprm[i, 2] and data.actuator_force[i]:
        yield f"{where}: its force is that at zero velocity"
