"""Boxes on a floor, apart or in a heap: families of sparse problems that a study makes itself."""

from typing import Final

import numpy as np

from quasistatic_ref.lab.scenes.piles import SIDE, pile
from quasistatic_ref.lab.study.problems.dials import MADE
from quasistatic_ref.lab.study.problems.making import problem_of
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.simulate.result import StepResult

YAW: Final = 0.3
"""Each box of those apart is turned by up to so much [rad]."""
LOAD: Final = 0.7
"""And pushed along x and along y by up to so much of its weight, of which friction holds half [-].

The first box of a heap is pushed along x by more than all weights."""
SETTLED: Final = 10
"""Steps after which the boxes of a heap press on each other."""


def problems_of_boxes(family: str, count: int, most: float | None = None) -> list[Problem]:
    """Some problems of ``"apart"`` or ``"heap"``, evenly along the number of boxes.

    Parameters
    ----------
    family : str
    count : int
    most : float, optional
        Boxes of the largest; else those of the dial's end [-].
    """
    dial = MADE[family]
    last = dial["most"] if most is None else max(dial["first"], most)
    bodies = np.linspace(dial["first"], last, count) // 4 * 4  # a heap is two wide and two high
    found = []
    for number in dict.fromkeys(bodies.astype(int).tolist()):
        result = apart(number) if family == "apart" else heap(number)
        name = f"{family}/{number}/0"
        pressed = np.flatnonzero(result.solution.lam).tolist()
        found.append(problem_of(result.step, name, 4, pressed, dial=number))
    return found


def apart(bodies: int) -> StepResult:
    """A step of boxes that do not touch each other; each has four contacts with the floor."""
    made = pile((bodies, 1, 1), certify="full", gap=SIDE, yaw=YAW)
    weight = -made.simulator.generalised_force(made.q, 0.0)[2]
    force = np.zeros((bodies, 6))
    force[:, :2] = weight * np.random.default_rng(bodies).uniform(-LOAD, LOAD, (bodies, 2))
    return made.simulator.step(made.q, np.zeros(0), force.ravel())


def heap(bodies: int) -> StepResult:
    """A step of boxes in two layers, two boxes wide, all of which touch their neighbours."""
    made = pile((bodies // 4, 2, 2), certify="full")
    q = made.q
    for _ in range(SETTLED):
        result = made.simulator.step(q, np.zeros(0), made.force)
        q = result.q
    return result
