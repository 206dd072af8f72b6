"""What a step costs: through this package, through a bare CVXPY solve, and part by part.

Run ``python validation/bench_step.py``. All of it is measured in one run, each taking its
turn step by step, over the steps of bunny_grasp; medians are printed. The ratio promised is
solve_step with ``certify="off"`` (units, filling parameters, solving, converting back) against
``problem.solve`` of the same problem with its parameters set again: at most 2.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.through_cvxpy import CvxpySolver
from quasistatic_ref.solve.units import natural_units, to_natural
from quasistatic_ref.step.problem import StepProblem

PROMISED = 2.0
CERTIFY = ("off", "residual", "full")


def main() -> int:
    """Print the table; exit status 1 if a required backend's ratio is above the promise."""
    run = load_scenario("bunny_grasp").run()
    steps = [run.step_data(k) for k in range(run.steps)]
    parts = {part: 1e3 * float(np.median(s)) for part, s in run.seconds.items()}
    print("bunny_grasp, clarabel, certified in full, median per step [ms]:")
    print("  " + ", ".join(f"{part} {ms:.2f}" for part, ms in parts.items()))
    print(
        f"{'backend':10}{'bare':>8}" + "".join(f"{kind:>10}" for kind in CERTIFY) + "  off / bare"
    )
    failed = False
    for name in (n for n, entry in BACKENDS.items() if entry.required):
        ours, bare = CvxpySolver(steps[0], name), StepProblem(steps[0])
        options = BACKENDS[name].first(1e-12)
        times = np.zeros((len(steps), 1 + len(CERTIFY)))
        for k, step in enumerate(steps):
            natural = to_natural(step, natural_units(step))
            start = time.perf_counter()
            bare.fill(natural)
            bare.problem.solve(solver=name.upper(), warm_start=False, **options)
            times[k, 0] = time.perf_counter() - start
            for i, certify in enumerate(CERTIFY, start=1):
                start = time.perf_counter()
                solve_step(step, ours, certify=certify)
                times[k, i] = time.perf_counter() - start
        ratio = float(np.median(times[:, 1] / times[:, 0]))
        bare_ms, *rest = 1e3 * np.median(times, axis=0)
        row = f"{name:10}{bare_ms:8.2f}" + "".join(f"{ms:10.2f}" for ms in rest)
        print(f"{row}{ratio:12.2f}", flush=True)
        failed |= ratio > PROMISED
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
