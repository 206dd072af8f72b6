"""A scenario file (TOML, version 1): bodies, shapes, contacts and targets, ready to simulate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import (
    BackendError,
    InputError,
    ScenarioError,
    about_file,
    check_kind,
    keywords_named,
)
from quasistatic_ref.files.resources import scenario_path
from quasistatic_ref.files.scenario.bodies import (
    BodyEntry,
    OfBodies,
    body_entry,
    joint_tracks,
    stiffnesses,
)
from quasistatic_ref.files.scenario.checks import (
    check_made,
    check_motion,
    check_sizes,
    checked_fields,
    run_fields,
)
from quasistatic_ref.files.scenario.contacts import contact_pairs, placed_shapes
from quasistatic_ref.files.scenario.other_files import other_file
from quasistatic_ref.files.scenario.overrides import Changes, Origins, about_changes, apply_settings
from quasistatic_ref.files.scenario.paths import folders_in
from quasistatic_ref.files.scenario.scenario_table import FORMAT, TOP, VERSION
from quasistatic_ref.files.scenario.scene_words import HERE, scene_tables
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import clipped, counted, one_line
from quasistatic_ref.shown import HasPage
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.observer import Observer, Recording
from quasistatic_ref.simulate.record.header import Record
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.stiffness import stiffness_of_parts
from quasistatic_ref.simulate.target import Loads, Targets, Wrenches
from quasistatic_ref.simulate.user_functions import Target
from quasistatic_ref.solve.backends import DEFAULT, Certify, check_function, is_function
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.extension import ExtensionOfQ
from quasistatic_ref.text.content import toml_read
from quasistatic_ref.text.plain import Plain, fingerprint
from quasistatic_ref.text.table_reader import TableReader
from quasistatic_ref.text.together import together

NAME = 32
"""Most characters of its name in a scenario's line."""
MOST_BODIES = 1000
"""Most bodies of a scenario: of 1000 free ones H, where it is formed whole, has 288 MB."""
ExtendedBodies = Callable[
    [System, tuple[ContactPair, ...], Mapping[str, BodyEntry], float, Array, Array],
    tuple[tuple[ContactPair, ...], OfBodies],
]
"""A system, its pairs, its bodies' entries, h [s], K_q (n_a, n_a) and gravity (3,) [m/s^2] -> the
pairs with those of supports, and what else is added to each step."""
FastBackend = Callable[[System, Sequence[ContactPair], str, str], str]
"""A system, its pairs, cone and law -> the backend of ``fast`` where none is named."""


class NamesTheScene(Observer):
    """Writes the fingerprint of a scene into the header of its run, also of one that fails."""

    def __init__(self, fingerprint: str) -> None:
        self.fingerprint = fingerprint

    def end(self, recorder: Recording, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with its fingerprint."""
        header = trajectory.header.with_fields(scene_sha256=self.fingerprint)
        return replace(trajectory, header=header)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Scenario(Settings, Plain, HasPage):
    """Everything that a scenario file says, checked and loaded.

    Parameters
    ----------
    path : Path
    steps : int
    targets : Targets
        q_bar_a(t).
    wrenches : tuple of Wrenches
        External wrenches [N, N m] in the world frame, each at the centre of mass of a root link.
    record : str
        What its trajectory holds.
    fast : bool
        Whether DAQP, by its own interface, is its backend where none is named.
    bodies : mapping of str to Body
        Those of its system, by their names.
    ignored_findings : tuple of str
        Names of findings that its runs do not say.
    of_bodies : callable, optional
        What tables of bodies add to each step: friction of joints and of supports, joint limits.
    settings
        As of :class:`~quasistatic_ref.simulate.settings.Settings`.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin", steps=3)
    >>> scenario.system.n_v, scenario.h
    (6, 0.01)
    """

    path: Path
    steps: int
    targets: Targets
    wrenches: tuple[Wrenches, ...] = ()
    record: Record = "full"
    fast: bool = False
    bodies: Mapping[str, Body] = field(default_factory=dict)
    ignored_findings: tuple[str, ...] = ()
    of_bodies: OfBodies | None = None

    def __repr__(self) -> str:
        name = clipped(one_line(self.path.stem), NAME)
        return (
            f"{type(self).__name__} {name}: {counted(self.steps, 'step')} of {self.h:g} s, "
            f"{counted(self.system.n_v, 'coordinate')}, {counted(len(self.pairs), 'contact pair')}"
        )

    @keywords_named
    def simulator(self, extension: ExtensionOfQ | None = None) -> Simulator:
        """A new simulator of this scenario, with the user's own constraints and costs, if any."""
        if self.of_bodies is not None:
            extension = self.of_bodies.beside(extension)
        return Simulator(**self.settings(), extension=extension)

    @property
    def target(self) -> Target:
        """The targets q_bar_a as a function of time, which ``rollout`` takes."""
        return self.targets

    @property
    def force(self) -> Callable[[float, Array], Array] | None:
        """External generalised force (t, q) -> (n_v,), or None where there is none."""
        return Loads(self.system, self.wrenches) if self.wrenches else None

    @property
    def fingerprint(self) -> str:
        """SHA-256 of what runs of this scene have in common, in hexadecimal.

        That is all but the number of steps, what is recorded and said, where a run ends early, and
        the way to its answers: backend, accuracy, certify and fast.
        """
        system = self.system
        driven = [(joint.name, joint.actuated) for joint in system.joints]
        words = [str(word) for word in (self.cone, self.law, self.distances)]
        physics = (self.h, self.K_q, self.gravity, self.gravity_acts, words)
        tracks = [(one.joint.name, one.times, one.values) for one in self.targets.tracks]
        model = (system.texts, driven, system.q_start, system.masses)
        drives = (self.targets.q_a_start, tracks, self.wrenches, self.of_bodies)
        sides = {side.name: side for pair in self.pairs for side in (pair.alpha, pair.beta)}
        pairs = [
            (one.name, one.alpha.name, one.beta.name, one.mu_v, one.mu_omega, one.rows, one.k)
            for one in self.pairs
        ]
        return fingerprint((model, physics, sides, pairs, drives))

    def findings(self) -> tuple[Finding, ...]:
        """What is wrong with the scene where it starts; a run's findings have these, too.

        Raises
        ------
        InputError
            If there is no ``optional/doctor``.
        """
        force = None if self.force is None else self.force(0.0, self.system.q_start)
        every = self.simulator().findings(force=force)
        return tuple(one for one in every if one.name not in self.ignored_findings)

    @keywords_named
    def run(
        self,
        progress: bool = True,
        observers: Sequence[Observer] = (),
        *,
        findings: bool = True,
    ) -> Trajectory:
        """Simulate the whole scenario.

        Parameters
        ----------
        progress : bool
        observers : sequence of Observer
        findings : bool
            As :func:`~quasistatic_ref.simulate.rollout.rollout` takes it.

        Raises
        ------
        RunFailed
            If a step fails.
        InputError
            If `progress` is no boolean, or as of :func:`~quasistatic_ref.simulate.rollout.rollout`.
        """
        if not isinstance(progress, bool):
            problem = "must be true or false; steps are set when the scenario is loaded"
            raise InputError(problem, field="progress", value=progress)
        return rollout(
            self.simulator(),
            self.system.q_start,
            self.target,
            self.steps,
            force=self.force,
            record=self.record,
            progress=progress,
            findings=findings,
            ignore=self.ignored_findings,
            observers=[*observers, NamesTheScene(self.fingerprint)],
        )


def load_scenario(
    name: str | PathLike[str] | Mapping[str, Any],
    settings: Changes = (),
    *,
    backend: str | None = None,
    certify: Certify | None = None,
    accuracy: float | None = None,
    of_others: bool = False,
    **fields: Any,
) -> Scenario:
    """Load a scenario from a file, by the name of one of the package, or from a mapping.

    Parameters
    ----------
    name : str, path or mapping
        A file; the name of a scenario that comes with the package; or the tables themselves, as
        :func:`~quasistatic_ref.files.scenario.scene_words.scene_tables` takes it.
    settings : sequence of str, or mapping of str to object
        Changes, made before anything is checked: ``dotted.key=value``, as after the command
        line's ``--set``; or values by dotted key, ``{"contacts.grip.mu_omega": 0}``.
    backend, certify, accuracy : optional
        In place of those of the table ``[solver]``; `accuracy` in natural units [-].
    of_others : bool
        Whether a mapping was written by someone whom you do not trust.
        It then may do what a file in the working folder may: its paths stay in that folder, and
        its backend is no function. A file always is of others; `settings` and `fields` are yours.
    fields : object
        The same as `settings` for fields at the top: ``steps=120``.

    Returns
    -------
    Scenario

    Raises
    ------
    InputError
        Naming the file, the field and the value; a ScenarioError or, from a URDF, a ModelError.

    Examples
    --------
    >>> loose = {"contacts.grip.mu_omega": 0.0}
    >>> qr.load_scenario("bunny_grasp", loose, backend="osqp", steps=3).backend
    'osqp'
    >>> scene = {
    ...     "h": 0.01,
    ...     "steps": 5,
    ...     "bodies": {"ball": qr.Body.of_shape("ball", qr.Sphere(0.05), 0.3, xyz=(0, 0, 0.05))},
    ...     "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
    ...     "contacts": {"rest": {"alpha": "floor", "beta": "ball", "mu_v": 0.5, "rows": 4}},
    ... }
    >>> qr.load_scenario(scene).run(progress=False).steps
    5
    """
    chosen = {"backend": backend, "certify": certify, "accuracy": accuracy}
    fields |= {f"solver.{word}": one for word, one in chosen.items() if one is not None}
    if isinstance(word := fields.get("solver"), str):
        problem = "is the table of backend, certify and accuracy; did you mean 'backend'?"
        raise ScenarioError(problem, field="solver", value=word)
    if isinstance(name, Mapping):
        tables = scene_tables(name)
        origins = Origins(not of_others)
        with about_changes(origins):
            apply_settings(tables, settings, fields, origins)
            check_sizes(tables)
            return _scenario(HERE, origins.reader(tables))
    check_kind(name, str | PathLike, "name", "a path, an installed scenario's name or a mapping")
    path = scenario_path(name)
    origins = Origins(False)
    with about_file(path), about_changes(origins):
        if path.is_file() and (kind := other_file(path)):
            raise ScenarioError(f"is no scenario, but {kind}")
        tables = toml_read(path, ScenarioError, "a scenario, which is TOML")
        check_made(apply_settings(tables, settings, fields, origins), tables)
        check_sizes(tables)
        return _scenario(path, origins.reader(tables))


@together()
def _scenario(path: Path, top: TableReader) -> Scenario:
    if not {"format", "version"} <= set(top.names_left()):  # another format's names are no mistakes
        checked_fields(top, TOP)
    top.check_format(FORMAT, VERSION)
    read = checked_fields(top, TOP)
    solver = read("solver")
    run = run_fields(read, solver)
    gravity = read("gravity")
    named = cone(read("cone")).name
    law = read("law")
    distances = read("distances")

    tables = read("bodies")
    if (count := len(tables.names_left())) > MOST_BODIES:
        problem = (
            f"are more than {MOST_BODIES}; whole arrays such as H take memory with the square of "
            "their number, and no larger scene is tested"
        )
        raise ScenarioError(problem, field="bodies", value=count)
    roots = folders_in(path.parent, top, "roots", read("roots"))
    entries = {
        name: body_entry(name, tables.table(name), path.parent, roots)
        for name in tables.names_left()
    }
    tables.close()
    if not entries:
        raise ScenarioError("has no bodies; add at least one table [bodies.NAME]", field="bodies")
    system = System([entry.body for entry in entries.values()])
    shapes = placed_shapes(system, entries, read("shapes"), path.parent)
    pairs = contact_pairs(read("contacts"), shapes, system.kinematics(system.q_start))
    parts = (part for entry in entries.values() for part in stiffnesses(system, entry))
    K_q = stiffness_of_parts(parts, system.n_a)
    of_bodies = None
    if any(entry.extends for entry in entries.values()):
        extended_bodies: ExtendedBodies = part("extended_bodies")
        pairs, of_bodies = extended_bodies(system, pairs, entries, run["h"], K_q, gravity)
    backend = run["backend"]
    if backend is not None and is_function(backend) and not solver.is_of_user("backend"):
        problem = "would run code, which no file may; give it as --backend FILE.py:NAME"
        raise solver.error_about("backend", problem, backend)
    check_function(backend)
    if backend is None and run["fast"]:
        fast_backend: FastBackend = part("fast_backend")
        run["backend"] = fast_backend(system, pairs, named, law)
    elif backend is None:
        run["backend"] = DEFAULT
    check_motion(system, pairs)
    if far := run["limits"].out_of_reach(system.links, system.kinematics(system.q_start).t):
        raise ScenarioError(f"at the start, {far}", field="bodies")

    gravity_acts = np.zeros(system.n_a, dtype=bool)
    tracks = []
    wrenches = []
    for entry in entries.values():
        for joint in entry.actuated(system).values():
            gravity_acts[joint.v] = not entry.gravity_compensated
        tracks += joint_tracks(system, entry)
        if entry.wrenches is not None:
            wrenches.append(entry.wrenches)
    try:
        return Scenario(
            path=path,
            **run,
            gravity=gravity,
            system=system,
            pairs=pairs,
            K_q=K_q,
            gravity_acts=gravity_acts,
            targets=Targets(system.q_start[: system.n_q_a], tracks),
            wrenches=tuple(wrenches),
            cone=named,
            bodies={name: entry.body for name, entry in entries.items()},
            of_bodies=of_bodies,
            law=law,
            distances=distances,
        )
    except BackendError as error:
        raise solver.error_about(error.field or "backend", error.problem, error.value) from None
