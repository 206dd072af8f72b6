"""Problems made of steps, those of the runs of scenarios, with their exact answers."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from quasistatic_ref.certify.norm import error_length, single_loads
from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.lab.study.problems.answers import exact_answer
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.lab.study.problems.selection import evenly
from quasistatic_ref.lab.study.program import units_of
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form

SCENARIOS = "scenarios"
"""The family of steps of runs, which has no dial."""


def problems_of_runs(scenarios: Sequence[str], total: int, progress: bool = True) -> list[Problem]:
    """Steps of the runs of scenarios, evenly spaced and never twice.

    Parameters
    ----------
    scenarios : sequence of str
        Names, or files.
    total : int
        At most so many, shared among the scenarios.
    progress : bool
        Whether to show a bar on standard error, where that is a terminal.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C.
    RunFailed
        If a step of a run fails.
    """
    problems = []
    with progress_bar(total=total, unit="problem", words="exact answers", shown=progress) as bar:
        for i, name in enumerate(scenarios[:total]):
            scenario = load_scenario(name, record="full", fast=True)
            run = _run(scenario)
            share = total // len(scenarios) + (i < total % len(scenarios))
            for s in evenly(run.steps, share):
                one = f"{SCENARIOS}/{Path(name).stem}/{s}"
                lam = run["lam"][s]
                pressed = np.flatnonzero(lam[np.isfinite(lam)])
                problems.append(problem_of(run.step_data(s), one, pressed.tolist()))
                bar.update()
    return problems


def _run(scenario: Scenario) -> Trajectory:
    """A run of the scenario whose every step is exact."""
    try:
        return scenario.run(progress=False, findings=False)
    except RunFailed as failure:
        if isinstance(failure.__cause__, KeyboardInterrupt):
            raise KeyboardInterrupt from None
        raise


def problem_of(step: StepData, name: str, warm: Sequence[int]) -> Problem:
    """A problem made of a step, with its exact answer.

    Parameters
    ----------
    step : StepData
    name : str
        Of the problem; its first part is the family.
    warm : sequence of int
        Rows that the exact method starts from, such as those that bear load in the exact step: in
        its float64 numbers, of which the problem is, they are nearly the same.
    """
    form = standard_form(step)
    H, g, A, b = form
    answer = exact_answer(form, warm)
    x = np.zeros(len(g)) if answer.farkas else answer.x
    facts: dict[str, Any] = {
        "id": name,
        "family": name.partition("/")[0],
        "kind": QP,
        "dial": None,
        "sequence": None,
        "length": error_length(H, g, x, single_loads(step)),
        "tags": [],
    }
    units = units_of(form)
    return Problem(facts, csr_matrix(H), g + 0.0, csr_matrix(A), b + 0.0, units, answer)
