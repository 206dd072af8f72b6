"""What exact certification costs: ``python -m validation.make.bench_exact [STEPS]``.

Steps of both bunny_grasp runs, and two families of random grasp-like steps; warm from the answers
of two backends, and cold. Times are of reading the backend's answer, forming H, g, A, b without
rounding, finding the optimum and rounding it; the backend's own time is not in them. The last
column is of `verify`, in rational numbers alone. It is processor time, of all threads together:
on an idle machine no less than what a clock shows, and on a busy one still the same question.

Promised, warm: a median of 5 ms and a 99th percentile of 15 ms on bunny_grasp, and a median of
40 ms with 30 contacts of six rows and 24 coordinates. Exit status 1 where that is broken.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from quasistatic_ref.certify.certificate import exact_certificate, verify
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY

GRASP = "bunny_grasp, 13 x 80"
FAMILIES = {
    "random, 13 x 80": {"n_u": 6, "n_a": 7, "grip": 10, "floor": 5},
    "random, 24 x 180": {"n_u": 12, "n_a": 12, "grip": 30, "floor": 0},
}
PROMISED = {GRASP: (5.0, 15.0), "random, 24 x 180": (40.0, np.inf)}
"""Median and 99th percentile of a warm start [ms]."""
STARTS = ("daqp", "clarabel", None)


Pressed = tuple[Array, Array, Array]


def backend_rows(step: StepData, backend: str | None) -> Pressed | None:
    """A, lam and the slacks of a backend's answer, in natural units; None if it has none."""
    if backend is None:
        return None
    solver = solver_for(step, backend)
    scaled = solver.scaled(step)
    try:
        answer = solver.answer(scaled, ACCURACY)
    except StepNotSolved:
        return None
    form = standard_form(scaled.natural)
    return form.A, answer.lam, form.A @ answer.delta_q - form.b


def certified(step: StepData, pressed: Pressed | None) -> ExactOptimum:
    """The exact optimum: what is timed."""
    return exact_step(step, warm_rows(*pressed) if pressed else [])


def milliseconds(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and the processor time it took [ms]."""
    start = time.process_time()
    result = call()
    return result, 1e3 * (time.process_time() - start)


def families(steps: int) -> Iterator[tuple[str, list[StepData]]]:
    """So many steps of each family; those of bunny_grasp spread over both of its runs."""
    grasp = []
    for own in CASES.values():
        run = load_scenario("bunny_grasp", own, fast=True).run()
        grasp += [run.step_data(k) for k in range(run.steps)]
    yield GRASP, [grasp[int(k)] for k in np.linspace(0, len(grasp) - 1, min(steps, len(grasp)))]
    for family, size in FAMILIES.items():
        rng = np.random.default_rng(1)
        yield family, [grasp_step(rng, **size) for _ in range(steps)]


def main(steps: int) -> int:
    """Print a table, and whether the promises are kept."""
    print(f"{'family':21} {'start':9} {'median ms':>9} {'p99 ms':>7} {'walks':>6} {'verify ms':>9}")
    report, broken = [], False
    for family, problems in families(steps):
        answers = []
        for backend in STARTS:
            cost, walks, checks, bits = [], [], [], []
            for step in problems:
                pressed = backend_rows(step, backend)
                optimum, ms = milliseconds(lambda s=step, p=pressed: certified(s, p))
                certificate = exact_certificate(step, optimum)
                claims = (step, optimum.delta_q, certificate.active, optimum.lam, certificate)
                verdict, check = milliseconds(lambda c=claims: verify(*c))
                assert verdict.ok, verdict.reason
                cost.append(ms), walks.append(optimum.walks), checks.append(check)
                bits.append((optimum.delta_q.tobytes(), optimum.net.tobytes()))
            answers.append(bits)
            median, p99 = np.median(cost), np.percentile(cost, 99)
            print(
                f"{family:21} {backend or 'cold':9} {median:9.1f} {p99:7.1f} "
                f"{np.median(walks):6.0f} {np.median(checks):9.1f}",
                flush=True,
            )
            if backend and family in PROMISED:
                most = PROMISED[family]
                kept = bool(median <= most[0] and p99 <= most[1])
                broken |= not kept
                limits = f"median <= {most[0]:g} ms"
                limits += f", p99 <= {most[1]:g} ms" if np.isfinite(most[1]) else ""
                report.append(f"{family} from {backend}: {limits}: {'kept' if kept else 'BROKEN'}")
        assert answers[0] == answers[1] == answers[2]
    print(f"equal bits of delta_q and A'lam from every start, {steps} steps each")
    print("\n".join(report))
    return int(broken)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
