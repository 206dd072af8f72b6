"""A run resumed: its saved steps taken over, and its solver brought to where it was."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.optional.between import POSED
from quasistatic_ref.optional.runs.saved_files import SavedSteps, first_step, run_settings
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.recorder import Recorder, programs
from quasistatic_ref.simulate.result import StepArrays
from quasistatic_ref.simulate.rollout import BEGUN_OR_RESUMED, SAVE_EVERY
from quasistatic_ref.simulate.user_functions import needed_arguments
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array, StepData

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.user_functions import Checked


def begun_or_resumed(
    path: str | Path,
    every: float | None,
    resume: bool,
    steps: int,
    recorder: Recorder,
    given: Mapping[str, tuple[object, Checked]],
    cold_every: int,
) -> SavedSteps:
    """Add the observer that saves a run to the recorder; with `resume`, load the saved steps.

    Saved steps are handed to the recorder, and those since the solver last started cold are posed
    to the solver again.

    Parameters
    ----------
    path : str or Path
        Of its trajectory.
    every : float or None
        Time between two saves [s].
    resume : bool
        Whether the run goes on from the saved steps.
    steps : int
        Of the whole run.
    recorder : Recorder
        At the start of the run, with all other observers.
    given : mapping of str to (object, callable)
        ``"target"`` and ``"force"``, as they were given, and as functions of (t, q, last).
    cold_every : int
        Steps after which the solver starts cold.

    Raises
    ------
    InputError
        If the time is no number of seconds, steps that are there would be lost or are of another
        run, or a target or force cannot be asked again.
    """
    first = first_step(path, steps, resume)
    simulator = recorder.simulator
    settings = run_settings(simulator, recorder.start, recorder.record)
    saved = SavedSteps(path, settings, recorder.notes, SAVE_EVERY if every is None else every)
    recorder.observers.append(saved)
    try:
        if first:
            _taken_over(saved, recorder, given, first // cold_every * cold_every)
    except BaseException:
        saved.lock.release()
        raise
    return saved


def _taken_over(
    saved: SavedSteps, recorder: Recorder, given: Mapping[str, tuple[object, Checked]], cold: int
) -> None:
    """Hand the saved steps to the recorder, and those from the step `cold` on to the solver."""
    for name, (function, _) in given.items():
        if callable(function) and needed_arguments(function, name) == 3:
            problem = "cannot be asked again: the results of saved steps are not kept"
            raise InputError(problem, field=name)
    recorder.simulator.start_cold()
    for part, extra in list(saved.parts()):
        again = _posed_again(part, recorder, given["target"][1], given["force"][1], cold)
        recorder.take(part | again, extra)


def _posed_again(
    part: StepArrays, recorder: Recorder, target: Checked, force: Checked, cold: int
) -> StepArrays:
    """What a full record adds to the steps of a part, which follow those of the recorder.

    From the step `cold` on, the solver is asked for each.
    """
    simulator = recorder.simulator
    full = recorder.record == "full"
    steps: list[StepData] = []
    for i, q in enumerate([recorder.q, *part["q"][:-1]]):
        k = recorder.steps + i
        t = (k + 1) * recorder.h
        goal = target(t, q, None)
        pushed = force(t, q, None)
        _check("target", k, part["q_bar_a"][i], goal)
        _check("force", k, part["tau"][i], simulator.generalised_force(q, pushed))
        if full or k >= cold:
            step, linear = _step(simulator, q, goal, pushed)
            _check("scene", k, part["phi"][i], step.contacts.phi)
            recorder.alone &= linear
            if k >= cold:
                _ask(simulator, step, linear)
            if "s" in part:
                step = step.replace(contacts=step.contacts.raised(part["s"][i]))
            steps.append(step)
    return programs(steps) if full else {}


def _step(simulator: Simulator, q: Array, goal: Array, pushed: Array) -> tuple[StepData, bool]:
    """The step from q, and whether that holds all there is of an extension."""
    kinematics = simulator.system.kinematics(q)
    points = simulator.closest_points(kinematics)
    step = simulator.step_data(q, goal, pushed, points, kinematics)
    if simulator.extension is None:
        return step, True
    return POSED.needed("extension")(step, simulator.extension(q))


def _ask(simulator: Simulator, step: StepData, linear: bool) -> None:
    """Ask the solver as the step did, for what it keeps; nothing else is done with it."""
    solver = simulator.solver
    if not linear or not (solver is None or solver.remembers):
        return
    if simulator.law == COULOMB or simulator.backend == NONE:  # asked for each iterate, or optimum
        simulator.solution(step)
        return
    with suppress(StepNotSolved):
        solve_step(step, simulator.fitting_solver(step), accuracy=simulator.accuracy, certify="off")


def _check(what: str, k: int, then: Array, now: Array) -> None:
    if not np.array_equal(then, now):
        problem = f"is not what the saved steps were taken with, from step {k} on; give the same"
        raise InputError(problem, field=what)


BEGUN_OR_RESUMED.fill(begun_or_resumed)
