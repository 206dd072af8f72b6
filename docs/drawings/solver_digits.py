"""What "optimal" is worth: correct digits of solvers on steps whose exact answer is known.

Every solver reports success at every one of these steps, at every accuracy. The certified
optimum of each step says how many digits of the answer are right.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

from quasistatic_ref.lab.cached_runs import grasp
from quasistatic_ref.lab.figures.labels import label_axes, legend_below
from quasistatic_ref.lab.figures.line_styles import COLOURS, DASHES, MARKS
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

BACKENDS = ("clarabel", "osqp", "piqp")
ACCURACIES = ("1e-3", "1e-6", "1e-9", "1e-12")
EVERY = 25
"""Which steps of the grasp are solved."""
SPREAD = 0.17
"""Distance between backends at the same accuracy, accuracies being one apart."""


@cache
def digits(backend: str, accuracy: str) -> Array:
    """Correct digits of delta_q at each step, shape (N,) [-]."""
    run = grasp("with torsion")[1]
    steps = [run.step_data(k) for k in range(0, run.steps, EVERY)]
    answers = [solve_step(step, backend, accuracy=float(accuracy)) for step in steps]
    return np.array([answer.statistics.digits for answer in answers], dtype=np.float64)


def figure(*, backends: Sequence[str] = BACKENDS, accuracies: Sequence[str] = ACCURACIES) -> Figure:
    """Digits against the accuracy of the call.

    Parameters
    ----------
    backends, accuracies : sequence of str
    """
    page, (axes,) = panels(4.4, 3.9)
    for k, backend in enumerate(backends):
        found = [digits(backend, accuracy) for accuracy in accuracies]
        x = np.arange(len(accuracies)) + SPREAD * (k - (len(backends) - 1) / 2)
        worst = [d.min() for d in found]
        best = [d.max() for d in found]
        axes.vlines(x, worst, best, colors=COLOURS[k], linewidth=scaled(1.0), linestyle=DASHES[k])
        axes.plot(
            x, [np.median(d) for d in found], linestyle="none", marker=MARKS[k],
            markersize=scaled(5.5), color=COLOURS[k], markeredgecolor="black", markeredgewidth=0.5,
            label=backend,
        )  # fmt: skip
    axes.set_xticks(range(len(accuracies)), accuracies)
    axes.grid(visible=False, axis="x")
    axes.set(ylim=(-0.6, 16.6), yticks=range(0, 17, 4))
    label_axes(
        axes, "accuracy asked of the backend [-]", r"correct digits of $\delta q$ [-]", key=False
    )
    key = "marker: median step; line: worst step to best"
    subject = f"{len(found[0])} steps of bunny_grasp, h = 10 ms, friction pyramid"
    legend_below([axes], axes.get_legend_handles_labels()[0], f"{key}; {subject}")
    return page
