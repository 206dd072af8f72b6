"""What a solver keeps between steps, what it refuses, and what is said of its answer."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import Extra, StepDataError, StepNotSolved, load_scenario, solve_step
from quasistatic_ref.certify.optimum import step_optimum
from quasistatic_ref.solve import solve
from quasistatic_ref.solve.backends import UNSAFE
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.units import ScaledStep
from tests.helpers import pinch, point_on_floor


def pushed_point(m=0.3, **changes):
    """A point that a load of 4 N slides along the floor."""
    return point_on_floor(m, 0.5, force=(4.0, 0.0, -3.0), **changes)


def test_only_backends_that_may_not_return_are_kept_from_unlike_rows():
    """Rows of the lengths 1 and 1e4: the backend is not called."""
    assert {"highs"} == UNSAFE
    step = pushed_point()
    unlike = step.replace(extra=Extra(("far",), [[1e4, 0.0, 0.0]], [-1.0]))
    for name, refused in (("highs", True), ("daqp", False)):
        assert solver_for(unlike, name).unsafe == refused
        solver_for(step, name).answer(ScaledStep(step), 1e-9)
    with pytest.raises(StepNotSolved, match="not called: its rows differ by"):
        solver_for(unlike, "highs").answer(ScaledStep(unlike), 1e-9)


def test_without_a_backend_the_exact_method_starts_from_the_working_set_of_the_step_before(
    monkeypatch,
):
    step = pinch(grip=5.0)
    cold = step_optimum(step)
    warm = step_optimum(step, cold.working_set)
    assert cold.walks > warm.walks == 0
    for name in ("delta_q", "net"):
        assert getattr(cold, name).tobytes() == getattr(warm, name).tobytes()
    fewer = pushed_point()
    assert fewer.m < max(cold.working_set)  # a row that the next step does not have
    onward = step_optimum(fewer, cold.working_set)
    assert onward.delta_q.tobytes() == solve_step(fewer, "none").delta_q.tobytes()
    starts = []
    proof = solve.optimum_by_groups
    monkeypatch.setattr(
        solve, "optimum_by_groups", lambda *a: starts.append(tuple(a[2][0])) or proof(*a)
    )
    simulator = load_scenario("two_finger_pinch", ["solver.backend=none"]).simulator()
    simulator.solution(step)
    simulator.solution(fewer)
    simulator.start_cold()
    simulator.solution(step)
    assert starts == [(), tuple(j for j in cold.working_set if j < fewer.m), ()]


def test_a_wrench_that_is_not_finite_is_refused_where_anything_is_claimed(monkeypatch):
    """Lam / h with lam = 1e300 N s and h = 1e-10 s."""
    step = pushed_point(h=1e-10)
    good = solve_step(step, certify="off")
    lam = np.full(len(good.lam), 1e300)
    with np.errstate(over="ignore"):
        bad = replace(good, lam=lam)
    monkeypatch.setattr(solve, "judged_solution", lambda *_: bad)
    with pytest.raises(StepDataError, match="range of float64"):
        solve_step(step, certify="residual")
    assert solve_step(step, certify="off") is bad
