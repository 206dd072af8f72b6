"""How near each backend comes to an active-set solver, on every step of both bunny_grasp runs.

Run ``python -m validation.make.backend_agreement`` (the extra ``test`` brings DAQP). Prints, for
each backend, the steps it did not solve and the quantiles of its error

    ||x - x*||_H / ||H^-1 g||_H,    x* being DAQP's answer at 1e-12 in natural units,

and exits with status 1 if a default backend is off by more than 1e-6 on any step.
"""

from __future__ import annotations

import sys

import numpy as np

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.backends import BACKENDS, installed_backends
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form

LIMIT = 1e-6
TRUTH = "daqp"


def error(step: StepData, x: np.ndarray, truth: np.ndarray) -> float:
    """Return ||x - truth||_H / ||H^-1 g||_H."""
    form = standard_form(step)
    unconstrained = np.linalg.solve(form.H, form.g)
    difference = x - truth
    return float(np.sqrt(difference @ form.H @ difference / (form.g @ unconstrained)))


def main() -> int:
    """Print the table."""
    steps: list[StepData] = []
    for own in CASES.values():
        run = load_scenario("bunny_grasp", [*own, f"solver.backend='{TRUTH}'"], fast=True).run()
        steps += [run.step_data(k) for k in range(run.steps)]
    truth = [solve_step(step, TRUTH).delta_q for step in steps]
    print(f"{len(steps)} steps; error against {TRUTH} at 1e-12")
    print(f"{'backend':22}{'unsolved':>9}{'median':>10}{'99 %':>10}{'worst':>10}")
    failed = False
    for name in [n for n in installed_backends() if n != TRUTH]:
        errors, solver = [], solver_for(steps[0], name)
        for step, x in zip(steps, truth, strict=True):
            solver = solver if solver.fits(step) else solver_for(step, name)  # the runs' mu differ
            try:
                answer = solve_step(step, solver, certify="off").delta_q
            except StepNotSolved:
                continue
            errors.append(error(step, answer, x))
        unsolved = len(steps) - len(errors)
        quantiles = np.quantile(errors, [0.5, 0.99, 1.0]) if errors else np.full(3, np.nan)
        print(f"{name:22}{unsolved:9d}" + "".join(f"{x:10.1e}" for x in quantiles), flush=True)
        if BACKENDS[name.split(":")[-1]].required:
            failed |= unsolved > 0 or not quantiles[-1] <= LIMIT
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
