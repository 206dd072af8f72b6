"""A MuJoCo scene as a scenario: what drives it, and how it runs."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.errors import InputError, ModelError, ScenarioError, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.optional.guests.settled import numbered
from quasistatic_ref.optional.guests.system import Actuation, MujocoSystem, Placed
from quasistatic_ref.parts import needed_package
from quasistatic_ref.scenario.overrides import Changes, apply_settings
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.scenario.scenario_table import LIMITS, SOLVER, TOP, value
from quasistatic_ref.simulate.finding import Finding, finding_table
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.settings import usable_backend
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.target import Targets, piecewise_linear
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.extension import ExtensionOfQ
from quasistatic_ref.tolerances import FILLED

if TYPE_CHECKING:
    from mujoco import MjData, MjModel

MARGIN = 0.05
"""Gap up to which MuJoCo looks for contacts, by default [m]."""
START: dict[str, Any] = {"h": 0.01, "steps": 100}
FIELDS = ("h", "steps", "cone", "record", "solver", "limits", "margin", "stiffness", "roots")

Drive = Callable[[float], Mapping[str, float]]
"""Controls of actuators and positions of joints by name, at a time [s]."""
Controls = Callable[[float], tuple[Array, dict[str, float]]]
"""Controls of all actuators, shape (nu,), and positions of joints by name, at a time [s]."""
Driven = Drive | str | Path | Sequence[str] | None


class MujocoSimulator(Simulator):
    """A simulator whose closest points are those that MuJoCo finds."""

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, in their places."""
        points = cast("Placed", kinematics).points
        assert points is not None
        return points


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class MujocoScenario(Scenario):
    """A MuJoCo scene, checked and ready to run; made by :func:`mujoco_scenario`.

    Parameters
    ----------
    of_mujoco : MujocoSystem
        Its system.
    actuation : callable
        What drives it at a time [s].
    """

    of_mujoco: MujocoSystem
    actuation: Callable[[float], Actuation]

    def simulator(self, extension: ExtensionOfQ | None = None) -> Simulator:
        """A simulator of this scene; an `extension` of one's own is not taken: InputError."""
        if extension is not None:
            raise InputError("is not taken by a MuJoCo scene", field="extension")
        system = self.of_mujoco
        own = system.extension if system.rows.names or len(system.rises) else None
        return MujocoSimulator(**self.settings(), extension=own)

    @property
    def force(self) -> Callable[[float, Array], Array]:
        """The force of motors, (t, q) -> (n_v,) [N, N m]."""
        return lambda t, q: self.of_mujoco.motors(q, self.actuation(t))

    def run(self, progress: bool = True, observers: Sequence[Observer] = ()) -> Trajectory:
        """Simulate the whole scene; as :meth:`.Scenario.run`."""
        return super().run(progress, [*observers, Crossing(progress)])


class Crossing(Observer):
    """Finds pairs that come from beyond the margin into each other in one step.

    Parameters
    ----------
    printed : bool
        Whether to print what is found on standard error.
    """

    def __init__(self, printed: bool) -> None:
        self.printed = printed

    def end(self, recorder: Recorder, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with its findings."""
        if not (trajectory.steps and recorder.simulator.pairs):
            return trajectory
        system = cast("MujocoSystem", recorder.system)
        first = system.places.first
        last = recorder.simulator.closest_points(system.kinematics(trajectory["q"][-1])).phi
        phi = np.vstack([trajectory["phi"], last])[:, first]
        steps, pairs = np.nonzero((phi[:-1] >= FILLED) & (phi[1:] < 0))
        if not len(steps):
            return trajectory
        k, j = int(steps[0]), int(pairs[0])
        depth = -float(phi[k + 1, j])
        remedy = "raise margin, or take a smaller h"
        cause = f"{recorder.simulator.pairs[j].name} comes from beyond the margin of "
        cause += f"{system.places.margin:g} m to {1e3 * depth:.3g} mm deep in step {k}, which had "
        cause += "no row for it"
        numbers = {"depth_mm": 1e3 * depth, "step": k}
        found = Finding("crossed margin", True, remedy, cause, numbers)
        if self.printed:
            print(f"quasistatic-ref: {found}", file=sys.stderr)
        findings = [*trajectory.header["findings"], finding_table(found)]
        return replace(trajectory, header={**trajectory.header, "findings": findings})


def mujoco_scenario(
    model: MjModel,
    data: MjData | None = None,
    targets: Driven = None,
    settings: Changes = (),
    path: str | Path = "scene.xml",
    **fields: Any,
) -> MujocoScenario:
    """A MuJoCo scene as a scenario, which runs, is recorded and is drawn as any other.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData, optional
        Where it starts; by default the model's first state, or that of the first keyframe named.
        Neither is changed.
    targets : str, Path, list of str or callable, optional
        A CSV table, of whose columns the first is ``t`` [s] and the others are actuators or joints;
        names of keyframes, whose controls are taken in turn; or a function of t that returns
        numbers by such names. Between rows or keyframes controls are linear, and what is not named
        stays.
    settings : sequence of str, or mapping of str to object
        As of ``load_scenario``, of h, steps, cone, record, solver, limits, ``margin`` (the gap up
        to which MuJoCo looks for contacts [m]) and ``stiffness.JOINT`` (of a spring towards the
        target of a joint that has no servo).
    path : str or Path
        What the scene is called.
    fields : object
        The same for fields at the top: ``steps=120``.

    Returns
    -------
    MujocoScenario

    Raises
    ------
    ScenarioError
        Naming a field.
    ModelError
        Naming element and field of what no run can say.

    Examples
    --------
    >>> import mujoco
    >>> falls = '<body pos="0 0 1"><freejoint/><geom size="0.1"/></body>'
    >>> text = f"<mujoco><worldbody>{falls}</worldbody></mujoco>"
    >>> scene = qr.mujoco_scenario(mujoco.MjModel.from_xml_string(text), steps=3)
    >>> scene.run(progress=False).q[:, 2].round(6)  # it falls by g h^2 a step [m]
    array([1.      , 0.999019, 0.998038, 0.997057])
    """
    mujoco = needed_package("mujoco", "engines", "mujoco_scenario")
    tables = dict(START)
    apply_settings(tables, settings, fields)
    top = TableReader(tables, error=ScenarioError)
    for name in top.names_left():
        if name not in FIELDS:
            problem = f"is not for a MuJoCo scene{suggestion(name, FIELDS)}"
            raise ScenarioError(problem, field=name, value=tables[name])
    named_cone = "cone" in tables
    top.take("roots", None)
    h, steps = value(top, TOP, "h"), value(top, TOP, "steps")
    margin = top.number("margin", MARGIN)
    stiffness = top.take("stiffness", {})
    if not isinstance(stiffness, Mapping):
        raise ScenarioError("must name joints: stiffness.JOINT=VALUE", field="stiffness")
    solver = value(top, TOP, "solver")
    limits = value(top, TOP, "limits")
    if data is None:
        data = mujoco.MjData(model)
        keys = () if callable(targets) or isinstance(targets, str | Path) else targets
        if keys:
            mujoco.mj_resetDataKeyframe(model, data, numbered(mujoco, model, "KEY", keys[0]))
    system = MujocoSystem(model, data, h, {**stiffness}, margin)
    elliptic = bool(model.opt.cone) and any(pair.mu_v for pair in system.places.pairs)
    cone = value(top, TOP, "cone") if named_cone else ELLIPSOID if elliptic else PYRAMID
    of_equalities = [n for n in system.rows.names if n.startswith("equality")]
    if cone == ELLIPSOID and of_equalities:
        held = of_equalities[0].partition(" (")[0]
        if named_cone:
            problem = 'is two rows, which leave the ellipsoid no interior; take cone = "pyramid"'
            raise ModelError(problem, field=held)
        cone = PYRAMID
        note = f'option.cone: elliptic; the run takes "pyramid", since {held} is two rows, which '
        system.notes = (*system.notes, note + "leave the ellipsoid no interior")
    certify = value(solver, SOLVER, "certify")
    controls, columns = controls_of(mujoco, model, data, steps * h, targets, system)
    actuation = _driven(system, controls, data.act.copy(), h)
    idle = [name for name, rows in columns.items() if _is_idle(system, rows, data.act, h)]
    free = system.q_start[: system.n_q_a]
    gravity = (
        np.zeros(3)
        if system.state(system.q_start).disables("GRAVITY")
        else model.opt.gravity.copy()
    )
    return MujocoScenario(
        path=Path(path),
        h=h,
        steps=steps,
        gravity=gravity,
        system=cast("System", system),  # a step, a recorder and findings ask for no other names
        of_mujoco=system,
        pairs=system.places.pairs,
        K_q=system.K_q,
        gravity_acts=np.ones(system.n_a, dtype=bool),
        targets=Drawn(free, (), lambda t, q: system.target(q, actuation(t)), tuple(idle)),
        backend=usable_backend(value(solver, SOLVER, "backend"), cone, certify),
        accuracy=value(solver, SOLVER, "accuracy"),
        certify=certify,
        record=value(top, TOP, "record"),
        cone=cone,
        limits=Limits(value(limits, LIMITS, "penetration"), value(limits, LIMITS, "reach")),
        actuation=actuation,
    )


@dataclass(frozen=True, eq=False)
class Drawn(Targets):
    """q_bar_a as a function of time and of where a step starts.

    Parameters
    ----------
    at : callable
    idle : tuple of str
        Columns of the table whose numbers change, and no force does.
    """

    at: Callable[[float, Array], Array]
    idle: tuple[str, ...] = ()

    def __call__(self, t: float, q: Array) -> Array:  # type: ignore[override]  # a Targets has t alone
        """q_bar_a at time t [s], of a step from q, shape (n_q_a,)."""
        return self.at(t, q)


def _driven(
    system: MujocoSystem, controls: Controls, act: Array, h: float
) -> Callable[[float], Actuation]:
    """What drives a scene at a time, from its controls and the activations, (na,), at the start.

    Those at a time are those of a step before and of the control since, so they are kept.
    """
    acts = [act]

    def at(t: float) -> Actuation:
        k = round(t / h)
        while len(acts) <= k:
            acts.append(system.activation_after(acts[-1], controls(h * len(acts))[0]))
        control, positions = controls(t)
        return Actuation(control, acts[k], positions)

    return at


def _is_idle(
    system: MujocoSystem, rows: Sequence[tuple[Array, dict[str, float]]], act: Array, h: float
) -> bool:
    """Whether controls differ, and yet have the same forces where the run starts."""
    q = system.q_start
    forces = set()
    for control, positions in rows:
        one = Actuation(control, system.activation_after(act, control), positions)
        forces.add((system.target(q, one).tobytes(), system.motors(q, one).tobytes()))
    return len(rows) > 1 and len(forces) == 1


def controls_of(
    mujoco: ModuleType,
    model: MjModel,
    data: MjData,
    T: float,
    targets: Driven,
    system: MujocoSystem,
) -> tuple[Controls, dict[str, list[tuple[Array, dict[str, float]]]]]:
    """Controls, shape (nu,), and positions at a time, from targets over T [s] in any form.

    And of each column of a table, the least and largest of its numbers alone, if they differ.

    Raises
    ------
    InputError
        Naming an actuator, joint or keyframe that is not there, or a joint without stiffness.
    """
    actuators = {mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i) or str(i): i
                 for i in range(model.nu)}  # fmt: skip
    joints = system.driven
    start = data.ctrl.copy()

    def checked(named: Mapping[str, float]) -> tuple[Array, dict[str, float]]:
        control = start.copy()
        positions = {}
        for name, number in named.items():
            if not np.isfinite(number):
                raise InputError("must be a finite number", field=f"targets.{name}", value=number)
            if name in actuators:
                control[actuators[name]] = number
            elif name in joints:
                positions[name] = float(number)
            else:
                known = (*actuators, *joints)
                problem = f"is no actuator, and no joint with a stiffness{suggestion(name, known)}"
                raise InputError(problem, field="targets", value=name)
        return control, positions

    if targets is None:
        return lambda t: (start, {}), {}
    if callable(targets):
        drive = targets
        checked(drive(0.0))
        return lambda t: checked(drive(t)), {}
    if isinstance(targets, str | Path):
        names, times, values = table_read(Path(targets))
        for row in values.tolist():
            checked(dict(zip(names, row, strict=True)))
        ends = {
            name: [checked({name: float(end)}) for end in (column.min(), column.max())]
            for name, column in zip(names, values.T, strict=True)
            if np.ptp(column)
        }

        def at(t: float) -> tuple[Array, dict[str, float]]:
            row = piecewise_linear(times, values, t).tolist()
            return checked(dict(zip(names, row, strict=True)))

        return at, ends
    keys = [numbered(mujoco, model, "KEY", name) for name in targets]
    for name, key in zip(targets, keys, strict=True):
        poses = (model.key_mpos[[key, keys[0]]], model.key_mquat[[key, keys[0]]])
        if any((own != first).any() for own, first in poses):
            problem = (
                f"moves bodies with mocap away from where {targets[0]} has them, and a run moves "
                "none; give the moved body joints with servos, or leave this keyframe out"
            )
            raise InputError(problem, field=f"keyframe {name}")
    times = np.linspace(0.0, T, len(keys)) if len(keys) > 1 else np.zeros(1)
    return lambda t: (piecewise_linear(times, model.key_ctrl[keys], t), {}), {}


def words(scene: MujocoScenario) -> str:
    """What may touch, within which gap, and how much is left out, and notes, in lines."""
    places = scene.of_mujoco.places
    notes = "".join(f"{note}\n" for note in scene.of_mujoco.notes)
    left_out = len(scene.of_mujoco.ignored)
    count = int(places.counts.sum())
    return (
        f"{notes}{len(places.pairs)} pairs of geoms with {count} places for contacts, within a "
        f"margin of {1e3 * places.margin:g} mm; {left_out} sentences of what is left out "
        "(system.ignored)"
    )


def table_read(path: Path) -> tuple[list[str], Array, Array]:
    """Names of columns, times (w,) [s] and values (w, columns) of a CSV table.

    Raises
    ------
    InputError
        Naming the file, and the row that is not one.
    """
    with about_file(path):
        rows = list(csv.reader(StringIO(text_of(bytes_read(path), path))))
        rows = [[entry.strip() for entry in row] for row in rows if row]
        if len(rows) < 2 or rows[0][0] != "t" or len(rows[0]) < 2:
            problem = "must begin with a row of names, t and then actuators or joints"
            raise InputError(problem, field="targets")
        for number, row in enumerate(rows[1:], start=2):
            if len(row) != len(rows[0]) or not all(map(_is_number, row)):
                problem = f"must have {len(rows[0])} numbers"
                raise InputError(problem, field=f"row {number}", value=",".join(row))
        numbers = np.array(rows[1:], dtype=np.float64)
        if not (np.isfinite(numbers).all() and (np.diff(numbers[:, 0]) > 0).all()):
            raise InputError("must be finite, and times must increase", field="targets")
        return rows[0][1:], numbers[:, 0], numbers[:, 1:]


def _is_number(entry: str) -> bool:
    try:
        float(entry)
    except ValueError:
        return False
    return True
