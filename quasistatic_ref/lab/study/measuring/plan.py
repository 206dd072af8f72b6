"""Every measurement of a study, in an order in which times can be compared.

Problems come in one scattered order, the same for all solvers, so that what a budget cuts off is
no family but a part of all; each problem goes to all solvers before the next one, they and
their settings in an order that is drawn for each: the first one finds cold caches.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from types import MappingProxyType
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.file.study_file import Part, Study
from quasistatic_ref.lab.study.store.rows import key_of

Sequences = Mapping[str, Sequence[tuple[str, str]]]
Modes = Mapping[str, tuple[str, ...]]


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
    mode : str
        What the solver keeps from step to step; empty where it is called on the problem alone.
    sequence : str
        The sequence of steps that is solved in order.
    """

    problem: str
    family: str
    solver: Solver
    setting: Setting
    units: str
    warm: bool
    repetition: int
    mode: str = ""
    sequence: str = ""

    @property
    def together(self) -> tuple[str, ...]:
        """What is the same of measurements that are never made apart: those of a sequence."""
        if self.sequence:
            return self.sequence, self.setting.name, self.units, self.mode
        return self.problem, str(self.repetition)

    @property
    def key(self) -> tuple[Any, ...]:
        """That of its row."""
        return key_of(self.fields())

    def fields(self) -> dict[str, Any]:
        """What a row says about itself."""
        return {
            "problem": self.problem,
            "family": self.family,
            "solver": self.solver.name,
            "interface": self.solver.interface,
            "setting": self.setting.name,
            "mode": self.mode,
            "warm": self.warm,
            "units": self.units,
            "repetition": self.repetition,
        }


def plan(
    study: Study,
    problems: Sequence[tuple[str, str]],
    sequences: Sequences = MappingProxyType({}),
    modes: Modes = MappingProxyType({}),
) -> list[Measurement]:
    """The measurements of a study, in order.

    Parameters
    ----------
    study : Study
    problems : sequence of (str, str)
        Id and family of each problem.
    sequences : mapping of str to sequence of (str, str)
        Those of them that are steps of sequences, in order, by the name of the sequence.
    modes : mapping of str to tuple of str
        In which each solver, by its label, can be called on sequences.

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
                if part.modes or not stride or place % stride:
                    continue
                here |= {m.key: m for m in _measurements(part, *problems[int(p)], repetition)}
            solvers = list(dict.fromkeys(m.solver.label for m in here.values()))
            turn = {label: i for i, label in enumerate(rng.permutation(solvers).tolist())}
            scattered = [list(here.values())[i] for i in rng.permutation(len(here))]
            for m in sorted(scattered, key=lambda m: turn[m.solver.label]):
                planned.setdefault(m.key, m)
    names = list(sequences)
    for place, i in enumerate(rng.permutation(len(names))):
        for part in study.parts:
            if part.modes and not place % part.every:
                ways = list(_in_order(part, modes, names[i], sequences[names[i]]))
                for j in rng.permutation(len(ways)):
                    planned |= {m.key: m for m in ways[j]}
    return list(planned.values())


def _measurements(part: Part, problem: str, family: str, repetition: int) -> Iterator[Measurement]:
    """The measurements of a part on one problem."""
    for solver, setting, units, warm in product(part.solvers, part.settings, part.units, part.warm):
        if solver.takes(setting) and (solver.warm or not warm):
            yield Measurement(problem, family, solver, setting, units, warm, repetition)


def _in_order(
    part: Part, modes: Modes, sequence: str, problems: Sequence[tuple[str, str]]
) -> Iterator[list[Measurement]]:
    """The measurements of a part on a sequence: a list for each solver, setting, units and mode."""
    for solver, setting, units, mode in product(
        part.solvers, part.settings, part.units, part.modes
    ):
        if solver.takes(setting) and mode in modes.get(solver.label, ()):
            yield [Measurement(problem, family, solver, setting, units, False, 0, mode, sequence)
                   for problem, family in problems]  # fmt: skip
