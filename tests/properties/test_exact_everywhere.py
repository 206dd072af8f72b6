"""Every backend and every start end at the same bits."""

from quasistatic_ref import load_scenario, solve_step, verify
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.rows import flat_rows
from quasistatic_ref.solve.backends import NONE

BACKENDS = ("clarabel", "osqp", "piqp", "daqp", NONE)


def assert_equal_bits(first, other):
    for name in ("delta_q", "net", "slack"):
        assert getattr(first, name).tobytes() == getattr(other, name).tobytes()
    for name in ("multipliers_unique", "differentiable", "smallest_inactive_slack"):
        assert getattr(first, name) == getattr(other, name)
    assert not first.multipliers_unique or first.lam.tobytes() == other.lam.tobytes()


def test_every_backend_ends_at_the_same_bits_of_a_grasp():
    """Approach, closing, squeeze and the first of the lift; its working sets lead there, too."""
    settings = ["steps=106", "solver.certify='residual'"]
    run = load_scenario("bunny_grasp", settings, fast=True).run(progress=False)
    for k in range(0, run.steps, 35):
        step = run.step_data(k)
        optimum = step_optimum(step)
        for backend in BACKENDS:
            solution = solve_step(step, backend)
            claims = solution.certificate
            assert solution.delta_q.tobytes() == optimum.delta_q.tobytes(), backend
            assert_equal_bits(step_optimum(step, flat_rows(step, claims.active)), optimum)
            assert verify(solution), backend
