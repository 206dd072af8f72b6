"""A MuJoCo scene as a scenario: what drives it, and how it runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.errors import InputError, ModelError, ScenarioError, check_kind
from quasistatic_ref.files.scenario.checks import run_fields
from quasistatic_ref.files.scenario.overrides import Changes, Origins, about_changes, apply_settings
from quasistatic_ref.files.scenario.scenario import FastBackend, Scenario
from quasistatic_ref.files.scenario.scenario_table import TOP, fields_of
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.bounds import stale
from quasistatic_ref.optional.mujoco.constraints import violated
from quasistatic_ref.optional.mujoco.drive import Drive, Driven, drive_of
from quasistatic_ref.optional.mujoco.mujoco import default_cone, first_equality
from quasistatic_ref.optional.mujoco.mujoco_state import package_of
from quasistatic_ref.optional.mujoco.places import overlapped_children
from quasistatic_ref.optional.mujoco.settled import settled
from quasistatic_ref.optional.mujoco.system import MujocoSystem, Placed
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.target import Targets
from quasistatic_ref.solve.backends import DEFAULT, check_function
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.extension import ExtensionOfQ
from quasistatic_ref.text.module_on_demand import ModuleOnDemand
from quasistatic_ref.text.plain import fingerprint
from quasistatic_ref.text.table_reader import TableReader

if TYPE_CHECKING:
    import mujoco
else:
    mujoco = ModuleOnDemand("mujoco")


MARGIN = 0.05
"""Gap up to which MuJoCo looks for contacts, by default [m]."""
START: dict[str, Any] = {"h": 0.01, "steps": 100}
RUN = ("h", "steps", "cone", "fast", "record", "solver", "limits", "findings")
FIELDS = (*RUN, "margin", "stiffness", "roots")


class MujocoSimulator(Simulator):
    """A simulator whose closest points are those that MuJoCo finds."""

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, each in its fixed place."""
        points = cast("Placed", kinematics).points
        assert points is not None
        return points


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class MujocoScenario(Scenario):
    """A MuJoCo scene, checked and ready to run; made by :func:`mujoco_scenario`.

    Parameters
    ----------
    drive : Drive
        What drives it; `targets` are where it starts.
    """

    drive: Drive

    def simulator(self, extension: ExtensionOfQ | None = None) -> Simulator:
        """A simulator of this scene; an `extension` of one's own is not taken: InputError."""
        if extension is not None:
            raise InputError("is not taken by a MuJoCo scene; leave it out", field="extension")
        system = self.drive.system
        rows = system.extension if system.rows.names or len(system.rises) else None
        return MujocoSimulator(**self.settings(), extension=rows)

    @property
    def fingerprint(self) -> str:
        """As of :attr:`.Scenario.fingerprint`; empty if a function of the user's drives it."""
        import mujoco  # it takes its time

        system = self.drive.system
        start = system.start
        if not isinstance(self.drive.values, partial):
            return ""
        model = np.empty(mujoco.mj_sizeModel(system.model), dtype=np.uint8)
        mujoco.mj_saveModel(system.model, None, model)
        state = (start.qpos, start.qvel, start.act, start.ctrl)
        settings = (self.h, self.K_q, self.cone, system.places.margin)
        return fingerprint((model, *map(np.array, state), settings, self.drive.values.args))

    @property
    def target(self) -> Drive:
        """q_bar_a, (t, q) -> (n_q_a,)."""
        return self.drive

    @property
    def force(self) -> Callable[[float, Array], Array]:
        """The force of motors, (t, q) -> (n_v,) [N, N m]."""
        return self.drive.force

    def run(
        self,
        progress: bool = True,
        observers: Sequence[Observer] = (),
        *,
        findings: bool = True,
    ) -> Trajectory:
        """Simulate the whole scene, as :meth:`.Scenario.run`.

        Raises
        ------
        RunFailed
            If a step fails; of the first one the scene's notes say more.
        """
        try:
            return super().run(progress, observers, findings=findings)
        except RunFailed as failure:
            if failure.trajectory.steps or not self.drive.system.notes:
                raise
            reason = "; ".join([failure.reason, *self.drive.system.notes])
            raise RunFailed(reason, failure.trajectory, failure.step) from failure


def mujoco_scenario(
    model: mujoco.MjModel,
    data: mujoco.MjData | None = None,
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
        As of ``load_scenario``, of h, steps, cone, fast, record, solver, limits, ``margin`` (the
        gap up to which MuJoCo looks for contacts [m]) and ``stiffness.JOINT`` (of a spring towards
        the target of a joint that has no servo).
    path : str or Path
        What the scene is called.
    fields : object
        The same for fields at the top: ``steps=120``.

    Returns
    -------
    MujocoScenario

    Raises
    ------
    InputError
        If `model`, `data` or `targets` are of another kind, or `targets` none.
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
    check_kind(data, package_of(model).MjData | None, "data", "a mujoco.MjData")
    check_kind(path, str | PathLike, "path", "a path")
    wanted = "a file, names of keyframes or a function"
    check_kind(targets, Sequence | PathLike | Callable | None, "targets", wanted)
    if isinstance(targets, Sequence) and not targets:
        raise InputError(f"must be {wanted}", field="targets", value=targets)
    tables = dict(START)
    origins = Origins(False)
    with about_changes(origins):
        apply_settings(tables, settings, fields, origins)
        return _scenario_of(model, data, targets, tables, Path(path))


def _scenario_of(
    model: mujoco.MjModel,
    data: mujoco.MjData | None,
    targets: Driven,
    tables: dict[str, Any],
    path: Path,
) -> MujocoScenario:
    top = TableReader(tables, error=ScenarioError)
    for name in top.names_left():
        if name not in FIELDS:
            problem = f"is not for a MuJoCo scene{suggestion(name, FIELDS)}"
            field, value = name, tables[name]
            while isinstance(value, Mapping) and value:  # down to what a change wrote
                key, value = next(iter(value.items()))
                field = f"{field}.{key}"
            raise ScenarioError(problem, field=field, value=value)
    top.take("roots", None)
    read = fields_of(top, TOP)
    run = run_fields(read, read("solver"))
    check_function(run["backend"])
    margin = top.number("margin", MARGIN)
    stiffness = top.take("stiffness", {})
    if not isinstance(stiffness, Mapping):
        raise ScenarioError("must name joints: stiffness.JOINT=VALUE", field="stiffness")
    if data is None:
        keys = () if callable(targets) or isinstance(targets, str | PathLike) else targets
        data = settled(model, 0.0, keys[0] if keys else None)
    system = MujocoSystem(model, data, run["h"], {**stiffness}, margin)
    if "cone" in tables:
        cone = read("cone")
        equality = first_equality(system.rows)
        if cone == ELLIPSOID and equality:
            problem = 'is two rows, which leave the ellipsoid no interior; take cone = "pyramid"'
            raise ModelError(problem, field=equality)
    else:
        rubs = any(pair.mu_v for pair in system.places.pairs)
        cone, system.notes = default_cone(model, rubs, system.rows)
    start = system.state(system.q_start)
    overlaps = overlapped_children(start, system.places)
    system.notes = (*system.notes, *stale(start), *violated(start), *overlaps)
    pairs = system.places.pairs
    if run["backend"] is None:
        run["backend"] = DEFAULT
        if run["fast"]:
            fast_backend: FastBackend = part("fast_backend")
            run["backend"] = fast_backend(cast("System", system), pairs, cone, CONVEX)
    floats = system.state(system.q_start).disables("GRAVITY")
    return MujocoScenario(
        path=path,
        **run,
        gravity=np.zeros(3) if floats else model.opt.gravity.copy(),
        system=cast("System", system),  # a step, a recorder and findings ask for no other names
        pairs=pairs,
        K_q=system.K_q,
        gravity_acts=np.ones(system.n_a, dtype=bool),
        targets=Targets(system.q_start[: system.n_q_a], ()),
        cone=cone,
        drive=drive_of(system, data, run["steps"] * run["h"], targets),
    )


def words(scene: MujocoScenario) -> str:
    """A scene's notes, and how many pairs, places for contacts and omissions the scene has."""
    places = scene.drive.system.places
    notes = "".join(f"{note}\n" for note in scene.drive.system.notes)
    left_out = len(scene.drive.system.ignored)
    count = int(places.counts.sum())
    return (
        f"{notes}{len(places.pairs)} pairs of geoms with {count} places for contacts, within a "
        f"margin of {1e3 * places.margin:g} mm; {left_out} sentences of what is left out "
        "(system.ignored)"
    )
