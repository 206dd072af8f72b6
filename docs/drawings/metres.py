"""What units do to a solver: the error of its answer in displacements, forces and natural units.

CVXPY's own ``solve`` gets (13) and (4) as printed, with displacements for unknowns, and ends
"optimal"; then ``StepProblem.problem``, in accelerations and forces. ``StepProblem.solve`` gives
this problem to the same solver in natural units.
"""

import warnings
from collections.abc import Sequence
from functools import cache

import cvxpy as cp
import numpy as np
from matplotlib.lines import Line2D

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref.certify.norm import correct_digits
from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.lab.figures.line_styles import MARKS
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.step_problem import CANON, StepProblem
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form

SCENES = ("sphere_spin", "two_finger_pinch", "bunny_grasp")
SOLVERS = ("clarabel", "osqp", "piqp", "daqp", "scs")
STEP = 11
"""Which step of each scene is solved."""
LEAST = 1e-16
"""Errors that are drawn as this one: float64 has no more digits."""
UNITS = ("displacements", "accelerations", "natural units")
FACES = ("0.3", "0.75", "white")


@cache
def step_of(scene: str) -> StepData:
    """A step of a scene."""
    return load_scenario(scene, steps=STEP + 1).run(progress=False).step_data(STEP)


def error(step: StepData, delta_q: Array) -> float:
    """||x - x*||_H over the length of the step [-], of an answer of shape (n_v,)."""
    return float(10.0 ** -correct_digits(step, delta_q, solve_step(step).delta_q))


@cache
def errors(scene: str, solver: str) -> tuple[float, float, float]:
    """Errors of a solver's answers with each choice of units [-]."""
    step = step_of(scene)
    H, g, A, b = standard_form(step)
    x = cp.Variable(step.n_v)
    printed = cp.Problem(cp.Minimize(cp.quad_form(x, H) / 2 - g @ x), [A @ x >= b])
    page = StepProblem(step)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a solution may be inaccurate
        for problem in (printed, page.problem):
            problem.solve(solver=solver.upper(), canon_backend=CANON)
    in_metres = error(step, x.value)
    return in_metres, error(step, page.primal()), error(step, page.solve(solver))


def figure(*, scenes: Sequence[str] = SCENES, solvers: Sequence[str] = SOLVERS) -> Figure:
    """Errors of each solver, on a step of each scene.

    Parameters
    ----------
    scenes, solvers : sequence of str
    """
    page, (axes,) = panels(4.4, 3.9)
    marked = {"linestyle": "none", "markeredgecolor": "black", "markeredgewidth": scaled(0.8)}
    marked |= {"markersize": scaled(5.5)}
    x = np.arange(len(solvers))
    for j, scene in enumerate(scenes):
        each = np.maximum([errors(scene, solver) for solver in solvers], LEAST)
        for k, face in enumerate(FACES):
            places = x + 0.2 * (j - 1)
            axes.plot(places, each[:, k], marker=MARKS[j], markerfacecolor=face, **marked)
    axes.set_yscale("log")
    axes.set_xticks(x, solvers)
    axes.grid(visible=False, axis="x")
    label = 'solver, with which CVXPY ends "optimal"'
    label_axes(axes, label, "error over the length of the step [-]", key=False)
    key = [
        Line2D([], [], marker=MARKS[j], markerfacecolor="white", label=scene, **marked)
        for j, scene in enumerate(scenes)
    ]
    key += [
        Line2D([], [], marker="s", markerfacecolor=face, label=unit, **marked)
        for unit, face in zip(UNITS, FACES, strict=True)
    ]
    legend_below([axes], key, f"step {STEP} of each scene")
    return page
