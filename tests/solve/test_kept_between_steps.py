"""What a solver keeps between steps, what it refuses, and what is said of its answer."""

from quasistatic_ref import Extra, load_scenario, solve_step
from quasistatic_ref.certify.optimum import step_optimum
from quasistatic_ref.solve import solve
from tests.helpers import pinch, point_on_floor
from tests.solvers import UNSAFE, NaturalStep, solver_for

PUSHED = point_on_floor(force=(4.0, 0.0, -3.0))
"""A point that a load of 4 N slides along the floor."""


def test_only_backends_that_may_not_return_are_kept_from_unlike_rows():
    """Rows of the lengths 1 and 1e4: the backend is not called."""
    assert {"highs"} == UNSAFE
    unlike = PUSHED.replace(extra=Extra(("far",), [[1e4, 0.0, 0.0]], [-1.0]))
    for name, refused in (("highs", True), ("daqp", False)):
        assert solver_for(unlike, name).unsafe == refused
        solver_for(PUSHED, name).reply(NaturalStep(PUSHED), 1e-9)
    reply = solver_for(unlike, "highs").reply(NaturalStep(unlike), 1e-9)
    assert reply.status.startswith("not called: its rows differ by")
    assert not reply.solved


def test_without_a_backend_the_exact_method_starts_from_the_working_set_of_the_step_before(
    monkeypatch,
):
    step = pinch(grip=5.0)
    cold = step_optimum(step)
    warm = step_optimum(step, cold.working_set)
    assert cold.iterations > warm.iterations == 0
    for name in ("delta_q", "net"):
        assert getattr(cold, name).tobytes() == getattr(warm, name).tobytes()
    assert PUSHED.m < max(cold.working_set)  # a row that the next step does not have
    onward = step_optimum(PUSHED, cold.working_set)
    assert onward.delta_q.tobytes() == solve_step(PUSHED, "none").delta_q.tobytes()
    starts = []
    proof = solve.optimum_by_groups
    monkeypatch.setattr(
        solve, "optimum_by_groups", lambda *a: starts.append(tuple(a[2][0])) or proof(*a)
    )
    simulator = load_scenario("two_finger_pinch", ["solver.backend=none"]).simulator()
    simulator.solution(step)
    simulator.solution(PUSHED)
    simulator.start_cold()
    simulator.solution(step)
    assert starts == [(), tuple(j for j in cold.working_set if j < PUSHED.m), ()]
