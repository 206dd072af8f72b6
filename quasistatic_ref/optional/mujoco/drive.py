"""What drives a MuJoCo scene: controls, activations and targets of joints as functions of time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from io import StringIO
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, about_field, about_file
from quasistatic_ref.files.rows import (
    BLANKS,
    check_decimal_point,
    check_separator,
    separator_of,
    words_of,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.settled import numbered
from quasistatic_ref.optional.mujoco.system import MujocoSystem
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.simulate.target import piecewise_linear
from quasistatic_ref.text.content import text_read

if TYPE_CHECKING:
    from mujoco import MjData

Driven = Callable[[float], Mapping[str, float]] | str | PathLike[str] | Sequence[str] | None
"""A function of time [s], a table, names of keyframes, or nothing."""


@dataclass(frozen=True, eq=False)
class Drive:
    """q_bar_a, and the forces of motors, as functions of time and of where a step starts.

    Parameters
    ----------
    system : MujocoSystem
    values : callable
        Controls, and targets of joints, at a time [s], shape (nu + joints,).
    acts : list of ndarray, shape (na,)
        Activations at the start and at the end of each step so far: each is that of the step before
        and of the control since [the actuators' units].
    idle : tuple of str
        Columns of the table whose numbers change, and no force does.
    """

    system: MujocoSystem
    values: Callable[[float], Array]
    acts: list[Array]
    idle: tuple[str, ...] = ()

    def at(self, t: float) -> tuple[Array, Array]:
        """Controls and targets of joints at a time [s], (nu + joints,), and activations, (na,)."""
        h = self.system.h
        k = round(t / h)
        while len(self.acts) <= k:
            values = self.values(h * len(self.acts))
            self.acts.append(_activations_after(self.system, self.acts[-1], values))
        return self.values(t), self.acts[k]

    def __call__(self, t: float, q: Array) -> Array:
        """q_bar_a at time t [s], of a step from q, shape (n_q_a,)."""
        with self.system.turn:
            return _q_bar_a(self.system, q, *self.at(t))

    def force(self, t: float, q: Array) -> Array:
        """The force of motors at time t [s] and q, shape (n_v,) [N, N m]."""
        with self.system.turn:
            return _motor_force(self.system, q, *self.at(t))


def _actuator_forces(
    system: MujocoSystem, q: Array, values: Array, act: Array
) -> tuple[Array, Array]:
    """Forces of servos, within their ranges, and of other actuators, (nv,) each [N, N m].

    `values` and the activations `act` are those of a Drive at a time.
    """
    state = system.state(q)
    data = state.data
    before = data.ctrl.copy(), data.act.copy()
    data.ctrl[:] = values[: len(data.ctrl)]
    data.act[:] = act
    state.mujoco.mj_fwdActuation(state.adapted, data)
    servos = system.servos
    moments = state.moments
    force = data.actuator_force[servos] @ moments[servos]
    # Where a servo acts, what the range of a joint or tendon takes away is the servo's.
    taken = data.qfrc_actuator - data.actuator_force @ moments
    force = force + np.where(moments[servos].any(axis=0), taken, 0.0)
    others = data.qfrc_actuator - force
    data.ctrl[:], data.act[:] = before
    state.mujoco.mj_fwdActuation(state.adapted, data)
    return force, others


def _motor_force(system: MujocoSystem, q: Array, values: Array, act: Array) -> Array:
    """The force of all actuators but servos, shape (n_v,) [N, N m]."""
    return np.asarray(system.T.T @ _actuator_forces(system, q, values, act)[1]) + 0.0


def _q_bar_a(system: MujocoSystem, q: Array, values: Array, act: Array) -> Array:
    """q_bar_a at which springs have the forces that MuJoCo's have at q, shape (n_q_a,)."""
    force = _actuator_forces(system, q, values, act)[0] + system.state(q).data.qfrc_spring
    short = values[system.model.nu :] - system.qpos(q)[system.driven_entries]
    for spring, length in zip(system.driven.values(), short, strict=True):
        force += spring.k * length * spring.m
    ahead = np.linalg.solve(system.K_q, (system.T.T @ force)[: system.n_a])
    return system.integrate(q, np.concatenate([ahead, np.zeros(system.n_u)]))[: system.n_q_a]


def _activations_after(system: MujocoSystem, act: Array, values: Array) -> Array:
    """Activations a time step later, (na,) [the actuators' units].

    A filter is at rest, where its activation is its control; an integrator's advances by h times
    its control. `act` are those before, and `values` those of a Drive.
    """
    model = system.model
    after = act.copy()
    for i in np.flatnonzero(model.actuator_actadr >= 0).tolist():
        place = model.actuator_actadr[i] + model.actuator_actnum[i] - 1
        u = values[i]
        if model.actuator_ctrllimited[i]:
            u = np.clip(u, *model.actuator_ctrlrange[i])
        after[place] = act[place] + system.h * u if i in system.integrators else u
        if model.actuator_actlimited[i]:
            after[place] = np.clip(after[place], *model.actuator_actrange[i])
    return after


def drive_of(system: MujocoSystem, data: MjData, T: float, targets: Driven) -> Drive:
    """The :class:`Drive` of a scene, from a state and targets over T [s] in any form.

    Raises
    ------
    InputError
        Naming an actuator, joint or keyframe that is not there, or a joint without stiffness.
    """
    model = system.model
    start = np.concatenate([data.ctrl, system.start.qpos[system.driven_entries]])
    names = [model.actuator(i).name or str(i) for i in range(model.nu)]
    places = {name: i for i, name in reversed([*enumerate([*names, *system.driven])])}

    def row(named: Mapping[str, float]) -> Array:
        values = start.copy()
        for name, number in named.items():
            if not np.isfinite(number):
                raise InputError("must be a finite number", field=f"targets.{name}", value=number)
            if name not in places:
                problem = "is no actuator, and no joint with a stiffness; name one"
                problem += suggestion(name, tuple(places))
                raise InputError(problem, field="targets", value=name)
            values[places[name]] = number
        return values

    values: Callable[[float], Array] = partial(piecewise_linear, np.zeros(1), start[None])
    idle: list[str] = []
    if callable(targets):
        function = targets
        row(function(0.0))  # refuses wrong names before the run

        def values(t: float) -> Array:
            return row(function(t))

    elif isinstance(targets, str | PathLike):
        with about_file(targets):
            columns, times, table = table_read(targets)
            rows = [row(dict(zip(columns, numbers, strict=True))) for numbers in table.tolist()]
        values = partial(piecewise_linear, times, np.array(rows))
        for name, column in zip(columns, table.T.tolist(), strict=True):
            ends = [row({name: end}) for end in {min(column), max(column)}]
            if (
                len(ends) > 1
                and len({_forces_at_start(system, end, data.act) for end in ends}) == 1
            ):
                idle.append(name)
    elif targets is not None:
        values = _of_keyframes(system, start, T, targets)
    return Drive(system, values, [data.act.copy()], tuple(idle))


def _forces_at_start(system: MujocoSystem, values: Array, act: Array) -> bytes:
    """All that servos and motors do where a run starts, of values and activations of a Drive."""
    q = system.q_start
    after = _activations_after(system, act, values)
    target = _q_bar_a(system, q, values, after)
    return np.concatenate([target, _motor_force(system, q, values, after)]).tobytes()


def _of_keyframes(
    system: MujocoSystem, start: Array, T: float, targets: Sequence[str]
) -> Callable[[float], Array]:
    """The controls of keyframes in turn, with the same time [s] between each two."""
    model = system.model
    keys = [numbered(model, "keyframe", name) for name in targets]
    for name, key in zip(targets, keys, strict=True):
        poses = (model.key_mpos[[key, keys[0]]], model.key_mquat[[key, keys[0]]])
        if any((pose != first).any() for pose, first in poses):
            problem = (
                f"moves bodies with mocap away from where {targets[0]} has them, and a run moves "
                "none; give the moved body joints with servos, or leave this keyframe out"
            )
            raise InputError(problem, field=f"keyframe {name}")
    rows = np.tile(start, (len(keys), 1))
    rows[:, : model.nu] = model.key_ctrl[keys]
    times = np.linspace(0.0, T, len(keys)) if len(keys) > 1 else np.zeros(1)
    return partial(piecewise_linear, times, rows)


def table_read(path: str | PathLike[str]) -> tuple[list[str], Array, Array]:
    """Names of columns, times (w,) [s] and values (w, columns) of a CSV table.

    Commas or semicolons part the words, which may be quoted.

    Raises
    ------
    InputError
        Naming the row that is not one.
    """
    first, _, rest = text_read(path).partition("\n")
    separator = separator_of(first)
    names = words_of(first.strip(), separator)
    if separator == BLANKS or names[0] != "t":
        problem = "must begin with a row of names, t and then actuators or joints, with commas"
        raise InputError(problem, field="targets", value=first)
    if twice := [name for name in names if names.count(name) > 1]:
        problem = "names a column twice; leave one of the two out"
        raise InputError(problem, field="targets", value=twice[0])
    numbers = np.zeros((0, 0))
    if any(line.partition("#")[0].strip() for line in rest.splitlines()):
        with suppress(ValueError):
            numbers = np.loadtxt(StringIO(rest), delimiter=separator, quotechar='"', ndmin=2)
    if numbers.shape[1] != len(names):
        _check_rows(rest, separator)
        problem = f"must be rows of {len(names)} numbers below the names"
        raise InputError(problem, field="targets", value=rest)
    if not (np.isfinite(numbers).all() and (np.diff(numbers[:, 0]) > 0).all()):
        raise InputError("must be finite, and times must increase", field="targets")
    return names[1:], numbers[:, 0], numbers[:, 1:]


def _check_rows(rows: str, separator: str) -> None:
    """Refuse the first of the rows below the names that has other separators, or decimal commas."""
    for number, line in enumerate(rows.splitlines(), start=2):
        row = line.partition("#")[0].strip()
        if not row:
            continue
        with about_field(f"targets, line {number}"):
            check_separator(row, separator, InputError)
            for word in words_of(row, separator):
                check_decimal_point(word, InputError)
