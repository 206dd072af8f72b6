"""Every measurement of a study, in an order in which times can be compared.

Problems come in one scattered order, the same for all solvers, so that what a budget cuts off is
no family but a part of all; on each problem all solvers are asked before the next one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.solvers import Setting, Solver
from quasistatic_ref.lab.study.spec import Study


@dataclass(frozen=True)
class Measurement:
    """One call of one solver.

    Parameters
    ----------
    problem : str
    family : str
    solver : Solver
    setting : Setting
    units : str
    warm : bool
    repetition : int
    """

    problem: str
    family: str
    solver: Solver
    setting: Setting
    units: str
    warm: bool
    repetition: int

    def fields(self) -> dict[str, Any]:
        """What a row says about itself."""
        return {
            "problem": self.problem,
            "family": self.family,
            "solver": self.solver.name,
            "interface": self.solver.interface,
            "setting": self.setting.name,
            "warm": self.warm,
            "units": self.units,
            "repetition": self.repetition,
        }


def plan(study: Study, problems: Sequence[tuple[str, str]]) -> list[Measurement]:
    """The measurements of a study, in order.

    Parameters
    ----------
    study : Study
    problems : sequence of (str, str)
        Id and family of each problem.

    Returns
    -------
    list of Measurement
        None twice, though several parts may ask for it.
    """
    order = np.random.default_rng(study.problems.seed).permutation(len(problems))
    most = max(part.repetitions for part in study.parts)
    planned: dict[tuple[object, ...], Measurement] = {}
    for repetition in range(most):
        for place, p in enumerate(order):
            problem, family = problems[int(p)]
            here: list[Measurement] = []
            for part in study.parts:
                if repetition >= part.repetitions or place % part.every:
                    continue
                turn = place % len(part.solvers)  # nobody always comes first
                for solver in (*part.solvers[turn:], *part.solvers[:turn]):
                    for setting in part.settings:
                        here += [
                            Measurement(problem, family, solver, setting, units, warm, repetition)
                            for units in part.units
                            for warm in part.warm
                            if solver.takes(setting) and (solver.warm or not warm)
                        ]
            for m in here:
                key = (problem, m.solver.label, m.setting.name, m.units, m.warm, repetition)
                planned.setdefault(key, m)
    return list(planned.values())
