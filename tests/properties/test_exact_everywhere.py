"""A sample of validation/make/exact_everywhere.py: every backend ends at the same bits."""

import numpy as np

from quasistatic_ref.certify.exact import exact_step
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.errors import StepInfeasible
from quasistatic_ref.scenario.scenario import load_scenario
from tests.oracles.random_steps import mixed_step
from validation.make.exact_everywhere import BACKENDS, checked


def test_every_backend_ends_at_the_same_bits_of_a_grasp():
    """Approach, closing, squeeze and the first of the lift."""
    settings = ["steps=106", "solver.certify='residual'"]
    run = load_scenario("bunny_grasp", settings, fast=True).run(progress=False)
    checks = [checked(run.step_data(k)) for k in range(0, run.steps, 35)]
    assert [check.faults for check in checks] == [[]] * 4
    assert all(check.kinds == {"optimal"} for check in checks)
    # Each certificate once for each coordinate and direction.
    assert all(check.refusals == 2 * 13 * check.certificates > 0 for check in checks)
    assert all(set(check.digits) == set(BACKENDS[:-1]) for check in checks)


def optimum_of(step, rows=()):
    """The optimum from a warm start; None, with its proof checked, if there is none."""
    try:
        return exact_step(step, rows)
    except StepInfeasible as failure:
        refusal = farkas_refutation(step, failure.farkas.exact)
    assert refusal is None
    return None


def test_every_backend_and_every_start_end_at_the_same_bits_of_random_steps():
    """Rows to start with: none, all, every other one backwards, at random."""
    optima, infeasible = [], 0
    for seed in range(60):
        step = mixed_step(seed)
        first, m = optimum_of(step), int(step.contacts.rows.sum())
        starts = (range(m), range(m - 1, -1, -2), np.random.default_rng(seed).permutation(m))
        others = [optimum_of(step, [int(i) for i in rows]) for rows in starts]
        if seed % 5 == 1 or (first is None and infeasible < 2):
            check = checked(step)
            assert check.faults == [], seed
            assert check.kinds == {"infeasible" if first is None else "optimal"}
        if first is None:
            infeasible += 1
            assert others == [None] * 3
            continue
        optima.append(first)
        for other in others:
            for name in ("delta_q", "net", "slack"):
                assert getattr(first, name).tobytes() == getattr(other, name).tobytes(), seed
            for name in ("multipliers_unique", "differentiable", "smallest_inactive_slack"):
                assert getattr(first, name) == getattr(other, name), seed
            assert not first.multipliers_unique or first.lam.tobytes() == other.lam.tobytes()
    assert infeasible >= 2
    assert sum(not o.multipliers_unique for o in optima) >= 8
    assert sum(len(o.working_set) == 0 for o in optima) >= 2
