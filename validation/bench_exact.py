"""What exact certification costs: ``python -m validation.bench_exact [STEPS]``.

Two families of random grasp-like steps; warm from the answers of two backends, and cold. Times
are of reading the backend's answer, forming H, g, A, b without rounding, finding the optimum and
rounding it; the backend's own time is not in them. The last column is of `verify`, in rational
numbers alone.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from quasistatic_ref.certify.certificate import exact_certificate, verify
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.solve.ask import backend_answer
from quasistatic_ref.solve.units import natural_units, to_natural
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY
from validation.random_steps import grasp_step

FAMILIES = {
    "13 x 80": {"n_u": 6, "n_a": 7, "grip": 10, "floor": 5},
    "24 x 180": {"n_u": 12, "n_a": 12, "grip": 30, "floor": 0},
}
STARTS = ("daqp", "clarabel", None)


Pressed = tuple[Array, Array, Array]


def backend_rows(step: StepData, backend: str | None) -> Pressed | None:
    """A, lam and the slacks of a backend's answer, in natural units; None if it has none."""
    if backend is None:
        return None
    natural = to_natural(step, natural_units(step))
    try:
        answer = backend_answer(natural, backend, ACCURACY)
    except StepNotSolved:
        return None
    form = standard_form(natural)
    return form.A, answer.lam, form.A @ answer.delta_q - form.b


def certified(step: StepData, pressed: Pressed | None) -> ExactOptimum:
    """The exact optimum: what is timed."""
    return exact_step(step, warm_rows(*pressed) if pressed else [])


def milliseconds(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and how long it took [ms]."""
    start = time.perf_counter()
    result = call()
    return result, 1e3 * (time.perf_counter() - start)


def main(steps: int) -> None:
    """Print a table."""
    print(f"{'family':10} {'start':9} {'median ms':>9} {'p99 ms':>7} {'walks':>6} {'verify ms':>9}")
    for family, size in FAMILIES.items():
        rng = np.random.default_rng(1)
        problems = [grasp_step(rng, **size) for _ in range(steps)]
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
            print(
                f"{family:10} {backend or 'cold':9} {np.median(cost):9.1f} "
                f"{np.percentile(cost, 99):7.1f} {np.median(walks):6.0f} {np.median(checks):9.1f}"
            )
        assert answers[0] == answers[1] == answers[2]
    print(f"equal bits of delta_q and A'lam from every start, {steps} steps each")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
