"""A run resumed: its saved steps taken over, and its solver brought to where it was."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.optional.runs.saved import EVERY, SavedRun, run_settings
from quasistatic_ref.parts import needed_part
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.recorder import Part, Recorder, program
from quasistatic_ref.simulate.rollout import start_cold
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array, StepData

if TYPE_CHECKING:
    from quasistatic_ref.simulate.goals import Checked
    from quasistatic_ref.simulate.simulator import Simulator


def saved_run(
    path: str | Path, every: float | None, simulator: Simulator, recorder: Recorder
) -> SavedRun:
    """The observer that saves a run.

    Parameters
    ----------
    path : str or Path
        Of its trajectory.
    every : float or None
        Time between two saves [s].
    simulator : Simulator
    recorder : Recorder
        With all other observers.

    Raises
    ------
    InputError
        If the time is no number of seconds.
    """
    settings = run_settings(simulator, recorder.start, recorder.record)
    return SavedRun(path, settings, recorder.notes, EVERY if every is None else every)


def resumed(
    saved: SavedRun,
    recorder: Recorder,
    simulator: Simulator,
    target: Checked,
    force: Checked,
    stretch: int,
) -> None:
    """Hand the saved steps to the recorder, and to the solver those since it last started cold.

    Parameters
    ----------
    saved : SavedRun
    recorder : Recorder
        At the start of the run.
    simulator : Simulator
    target, force : callable
        Of (t, q, last), of which `last` is not used; shapes (n_q_a,) and (n_v,) of their results.
    stretch : int
        Steps after which the solver starts cold.

    Raises
    ------
    InputError
        If the saved steps are of another run.
    """
    parts = list(saved.parts())
    taken = sum(len(part["t"]) for part, _ in parts)
    start_cold(simulator)
    for part, extra in parts:
        again = _Again(simulator, target, force, recorder.record, taken // stretch * stretch)
        recorder.take(part | again.posed(part, recorder), extra)


@dataclass(frozen=True)
class _Again:
    """How saved steps are posed again: all of a full record, of a light one those from `cold`."""

    simulator: Simulator
    target: Checked
    force: Checked
    record: str
    cold: int

    def posed(self, part: Part, recorder: Recorder) -> Part:
        """What a full record adds to the steps of a part, which follow those of the recorder."""
        rows: list[dict[str, Array]] = []
        for i, q in enumerate([recorder.q, *part["q"][:-1]]):
            k = recorder.steps + i
            t = (k + 1) * recorder.h
            goal, pushed = self.target(t, q, None), self.force(t, q, None)
            _check("target", k, part["q_bar_a"][i], goal)
            tau = self.simulator.generalised_force(q, pushed)
            _check("force", k, part["tau"][i], tau)
            if self.record == "full" or k >= self.cold:
                step, linear = self._step(q, goal, pushed)
                _check("scene", k, part["phi"][i], step.contacts.phi)
                recorder.alone &= linear
                if k >= self.cold:
                    self._ask(step, linear)
                if "s" in part:
                    raised = step.contacts.phi + part["s"][i]
                    step = step.replace(contacts=replace(step.contacts, phi=raised))
                rows.append(program(step) if self.record == "full" else {})
        return {key: np.array([row[key] for row in rows]) for key in (rows[0] if rows else ())}

    def _step(self, q: Array, goal: Array, pushed: Array) -> tuple[StepData, bool]:
        """The step from q, and whether that holds all there is of an extension."""
        simulator, kinematics = self.simulator, self.simulator.system.kinematics(q)
        points = simulator.closest_points(kinematics)
        step = simulator.step_data(q, goal, pushed, points, kinematics)
        if simulator.extension is None:
            return step, True
        extended = needed_part("extensions.extended", "extension")
        posed: tuple[StepData, bool] = extended.posed(step, simulator.extension(q))
        return posed

    def _ask(self, step: StepData, linear: bool) -> None:
        """Ask the solver as the step did, for what it keeps; nothing else is done with it."""
        simulator, solver = self.simulator, self.simulator.solver
        if not linear or not (solver is None or solver.remembers) or simulator.backend == NONE:
            return
        if simulator.law == COULOMB:  # it was asked for each iterate
            simulator.solution(step)
            return
        with suppress(StepNotSolved):
            solve_step(step, simulator.fitting(step), accuracy=simulator.accuracy, certify="off")


def _check(what: str, k: int, then: Array, now: Array) -> None:
    if not np.array_equal(then, now):
        problem = f"is not what the saved steps were taken with, from step {k} on; give the same"
        raise InputError(problem, field=what)
