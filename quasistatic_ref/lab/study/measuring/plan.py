"""Every measurement of a study, in an order in which times can be compared.

Problems come in one scattered order, the same for all solvers, so that what a budget cuts off is
no family but a part of all; each problem goes to all solvers before the next one, they and
their settings in an order that is drawn for each: the first one finds cold caches.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.file.study_file import Part, Study


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
        None twice, though several parts may contain it. After all problems some are run again,
        as repetition 1: how much these differ from the first is the noise of the study.
    """
    rng = np.random.default_rng(study.problems.seed)
    order = rng.permutation(len(problems))
    planned: dict[tuple[object, ...], Measurement] = {}
    for repetition in (0, 1):
        for place, p in enumerate(order):
            here: dict[tuple[object, ...], Measurement] = {}
            for part in study.parts:
                stride = part.every * (part.again if repetition else 1)
                if not stride or place % stride:
                    continue
                here |= {_key(m): m for m in _measurements(part, *problems[int(p)], repetition)}
            solvers = list(dict.fromkeys(m.solver.label for m in here.values()))
            turn = {label: i for i, label in enumerate(rng.permutation(solvers).tolist())}
            scattered = [list(here.values())[i] for i in rng.permutation(len(here))]
            for m in sorted(scattered, key=lambda m: turn[m.solver.label]):
                planned.setdefault(_key(m), m)
    return list(planned.values())


def _measurements(part: Part, problem: str, family: str, repetition: int) -> Iterator[Measurement]:
    """The measurements of a part on one problem."""
    for solver, setting, units, warm in product(part.solvers, part.settings, part.units, part.warm):
        if solver.takes(setting) and (solver.warm or not warm):
            yield Measurement(problem, family, solver, setting, units, warm, repetition)


def _key(m: Measurement) -> tuple[object, ...]:
    return m.problem, m.solver.label, m.setting.name, m.units, m.warm, m.repetition
