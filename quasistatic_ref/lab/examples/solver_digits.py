"""What "optimal" is worth: correct digits of solvers on steps whose exact answer is known.

Every solver reports success at every one of these steps, at every accuracy. The certified
optimum of each step says how many digits of the answer are right. docs/exactness.md has the same
for all 600 steps, and for problems that are not written in natural units.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.digits import BackendDigits, digits_of_backends
from quasistatic_ref.lab.runs import grasp
from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.solve.solve import solve_step

BACKENDS = ("clarabel", "osqp", "piqp")
ACCURACIES = ("1e-3", "1e-6", "1e-9", "1e-12")
EVERY = 25
"""Which steps of the grasp are solved."""


@cache
def records(backends: tuple[str, ...], accuracies: tuple[str, ...]) -> tuple[BackendDigits, ...]:
    """One for each backend and accuracy."""
    run = grasp("with torsion")[1]
    steps = [run.step_data(k) for k in range(0, run.steps, EVERY)]
    found = []
    for backend in backends:
        for accuracy in accuracies:
            answers = [solve_step(s, backend, accuracy=float(accuracy)) for s in steps]
            digits = np.array([a.statistics.digits for a in answers], dtype=np.float64)
            worst, low, median, best = np.quantile(digits, [0, 0.01, 0.5, 1])
            numbers = float(worst), float(low), float(median), float(best)
            found.append(BackendDigits("natural units", backend, accuracy, len(steps), 0, *numbers))
    return tuple(found)


def main() -> Numbers:
    """The worst step of each."""
    found = records(BACKENDS, ACCURACIES)
    return {f"worst digits, {r.backend} at {r.accuracy} [-]": r.worst for r in found}


def figure(
    ax: Any = None, *, backends: Sequence[str] = BACKENDS, accuracies: Sequence[str] = ACCURACIES
) -> Figure:
    """Digits against the accuracy of the call.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    backends, accuracies : sequence of str
    """
    found = records(tuple(backends), tuple(accuracies))
    subject = f"{found[0].steps} steps of bunny_grasp, h = 10 ms, friction pyramid"
    return digits_of_backends(found, subject, ax)
