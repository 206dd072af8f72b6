"""The four rows of a block that is pushed, with de Saxcé's correction and without.

Each row has a number lambda_i, a force times h, and a slack. One of the two is zero. Coulomb's law
adds sigma, the largest slip times its coefficient, to each slack; the convex program does not.
"""

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from docs.drawings.the_program import H, point
from quasistatic_ref import coulomb_step, solve_step
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.step.standard_form import standard_form

PUSH = 6.0  # N
ROWS = ("+d1", "+d2", "-d1", "-d2")


def rows(corrected: bool) -> tuple[Array, Array, float]:
    """Forces lambda / h [N] and slacks [m] of the four rows, and sigma [m] or 0."""
    step = point(PUSH)
    solution = (coulomb_step if corrected else solve_step)(step)
    form = standard_form(step)
    slack = form.A @ solution.delta_q - form.b
    gap = slack[[0, 2]].mean()  # opposite rows: the slips cancel
    sigma = float(np.max(gap - slack)) if corrected else 0.0
    return solution.lam / H, slack + sigma, sigma


def figure() -> Figure:
    """Left Coulomb's law, right the convex program: forces above, slacks below zero."""
    page, axes = panels(6.3, 3.2, columns=2, sharey=True)
    for one, corrected in zip(axes, (True, False), strict=True):
        forces, slacks, sigma = rows(corrected)
        x = np.arange(len(ROWS))
        one.bar(x, forces, 0.6, color="#0072B2", label=r"$\lambda_i / h$ [N]")
        one.bar(
            x, -1e5 * slacks, 0.6, color="#E69F00", label=r"slack of the row, downwards [10 $\mu$m]"
        )
        for k in range(len(ROWS)):
            pushes = forces[k] > 1e-6
            words = f"{forces[k]:.2f} N" if pushes else f"{1e6 * slacks[k]:.0f} µm"
            y = forces[k] + 0.2 if pushes else -1e5 * slacks[k] - 0.2
            one.text(k, y, words, ha="center", va="bottom" if pushes else "top")
        one.axhline(0, color="0.3", linewidth=0.8)
        one.set_xticks(x, ROWS)
        law = rf"with $\sigma$ = {1e6 * sigma:.0f} µm" if corrected else r"without $\sigma$"
        one.set(ylim=(-13, 13))
        one.set_axisbelow(True)
        one.grid(visible=False)
        label_axes(one, "row", title=law, key=False)
    axes[0].set_yticks([-10, -5, 0, 5, 10], ["10", "5", "0", "5", "10"])
    axes[0].set_ylabel("slack, force")
    axes[1].label_outer(remove_inner_ticks=True)
    legend_below(axes, axes[0].get_legend_handles_labels()[0])
    return page
