"""Every backend and every start end at the same bits."""

import numpy as np

from quasistatic_ref import StepInfeasible, load_scenario, solve_step, verify
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.rows import flat_rows
from quasistatic_ref.solve.backends import NONE
from tests.oracles.random_steps import mixed_step

BACKENDS = ("clarabel", "osqp", "piqp", "daqp", NONE)


def optimum_of(step, rows=()):
    """The optimum from a warm start; None, with its proof checked, if there is none."""
    try:
        return step_optimum(step, rows)
    except StepInfeasible as failure:
        refusal = farkas_refutation(step, failure.farkas.exact)
    assert refusal is None
    return None


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


def test_every_start_ends_at_the_same_bits_of_random_steps():
    """Rows to start with: none, all, every other one backwards, at random."""
    optima = []
    infeasible = 0
    for seed in range(24):
        step = mixed_step(seed)
        first = optimum_of(step)
        m = int(step.contacts.rows.sum())
        starts = (range(m), range(m - 1, -1, -2), np.random.default_rng(seed).permutation(m))
        others = [optimum_of(step, [int(i) for i in rows]) for rows in starts]
        if first is None:
            infeasible += 1
            assert others == [None] * 3
            continue
        optima.append(first)
        for other in others:
            assert_equal_bits(other, first)
    assert infeasible >= 2
    assert sum(not o.multipliers_unique for o in optima) >= 4
    assert sum(len(o.working_set) == 0 for o in optima) >= 1
