"""A state that MuJoCo's own simulation comes to, and how fast it still moves there."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError, ModelError, about_field
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.mujoco_state import check_finite
from quasistatic_ref.parts import needed_package
from quasistatic_ref.quoting import suggestion

if TYPE_CHECKING:
    from mujoco import MjData, MjModel

UNSTABLE = ("mjWARN_BADQPOS", "mjWARN_BADQVEL", "mjWARN_BADQACC")
"""Warnings after which MuJoCo begins again, from the model's first state."""


def settled(
    model: MjModel,
    seconds: float,
    keyframe: str | int | None = None,
    control: Mapping[str, float] | None = None,
) -> MjData:
    """MuJoCo's state after a while.

    Parameters
    ----------
    model : mujoco.MjModel
    seconds : float
        How long it settles [s].
    keyframe : str or int, optional
        Where it begins, by name or number: `qpos0` by default.
    control : mapping of str to float, optional
        Controls of actuators by name or number [the actuator's unit]; the others are those of the
        keyframe, or zero.

    Returns
    -------
    mujoco.MjData

    Raises
    ------
    InputError
        If there is no such keyframe or actuator, or the time is negative.
    ModelError
        If the state is not finite, or the simulation is unstable.
    """
    mujoco = needed_package("mujoco", "engines", "a MuJoCo scene")
    data = mujoco.MjData(model)
    if not 0 <= seconds < np.inf:
        raise InputError("must be zero or more seconds", field="settle", value=seconds)
    if keyframe is not None:
        mujoco.mj_resetDataKeyframe(model, data, numbered(model, "keyframe", keyframe))
    with about_field("control"):
        for name, value in (control or {}).items():
            data.ctrl[numbered(model, "actuator", name)] = value
    check_finite(model, data)
    run(model, data, seconds)
    return data


def velocities(model: MjModel, data: MjData, seconds: float) -> tuple[Array, Array]:
    """MuJoCo's mean velocities over some seconds [s], and over as many after them, (nv,) each.

    The controls stay those of `data`.

    Raises
    ------
    ModelError
        If the simulation is unstable.
    """
    import mujoco

    now = copy.copy(data)
    means = np.zeros((2, model.nv))
    for mean in means:
        before = copy.copy(now)
        run(model, now, max(seconds, model.opt.timestep))
        took = now.time - before.time
        mujoco.mj_differentiatePos(model, mean, took, before.qpos, now.qpos)
    return means[0], means[1]


class Window(NamedTuple):
    """The state with the most contacts within some time, and mean forces of those that hop.

    Parameters
    ----------
    data : mujoco.MjData
        The first state with most contacts.
    hops : dict of tuple of int to ndarray, shape (4,)
        Of the pairs of geoms that part and meet again, the mean force on the second, in the world
        frame [N], and the mean torque about the normal [N m].
    """

    data: MjData
    hops: dict[tuple[int, int], Array]

    def near(self, model: MjModel, reach: float) -> MjModel:
        """A copy of a model that lists contacts of hopping geoms up to a distance `reach` [m].

        They push no sooner: that is the margin's.
        """
        near = copy.copy(model)
        of = np.unique([geom for pair in self.hops for geom in pair]).astype(int)
        near.geom_gap[of] += reach
        near.pair_gap[np.isin(model.pair_geom1, of) | np.isin(model.pair_geom2, of)] += reach
        return near


def window(model: MjModel, data: MjData, seconds: float) -> Window:
    """MuJoCo's contacts over some `seconds` [s] after a state.

    What slides fast hops in MuJoCo: at one instant it may touch with one corner, or with none.

    Raises
    ------
    ModelError
        If the simulation is unstable.
    """
    import mujoco

    now = copy.copy(data)
    mujoco.mj_forward(model, now)
    most, count = data, now.ncon
    steps = max(round(seconds / model.opt.timestep), 1)
    touches: dict[tuple[int, int], Array] = {}
    sums: dict[tuple[int, int], Array] = {}
    for k in range(steps + 1):
        if k:
            run(model, now, model.opt.timestep)
            mujoco.mj_forward(model, now)
        if now.ncon > count:
            most, count = copy.copy(now), now.ncon
        force = np.zeros(6)
        for i, touch in enumerate(now.contact):
            pair = (int(touch.geom[0]), int(touch.geom[1]))
            mujoco.mj_contactForce(model, now, i, force)
            force[0] += touch.adhesion
            world = touch.frame.reshape(3, 3).T @ force[:3]
            touches.setdefault(pair, np.zeros(steps + 1, dtype=bool))[k] |= touch.exclude == 0
            sums[pair] = sums.get(pair, np.zeros(4)) + np.array([*world, force[3]])
    changes = {pair: np.diff(on.astype(int)) for pair, on in touches.items()}
    back = [pair for pair, ways in changes.items() if (ways > 0).any() and (ways < 0).any()]
    return Window(most, {pair: sums[pair] / (steps + 1) for pair in back})


def run(model: MjModel, data: MjData, seconds: float) -> None:
    """Let MuJoCo's state run for some seconds [s], in whole time steps.

    Raises
    ------
    ModelError
        If the simulation is unstable.
    """
    import mujoco

    before = _resets(data)
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    if _resets(data) > before:
        problem = "is too large: MuJoCo's simulation is unstable, and began again; lower it"
        raise ModelError(problem, field="option.timestep", value=model.opt.timestep)


def _resets(data: MjData) -> int:
    """How often MuJoCo began again."""
    import mujoco

    return sum(data.warning[getattr(mujoco.mjtWarning, name)].number for name in UNSTABLE)


def numbered(model: MjModel, kind: str, name: str | int) -> int:
    """The number of a keyframe or actuator, by its name or number; InputError if there is none."""
    keys = kind == "keyframe"
    element, count = (model.key, model.nkey) if keys else (model.actuator, model.nu)
    names = [element(i).name or str(i) for i in range(count)]
    if str(name) in names:
        return names.index(str(name))
    if str(name).isdecimal() and int(name) < count:
        return int(name)
    raise InputError(f"is not in the model{suggestion(str(name), names)}", field=kind, value=name)
