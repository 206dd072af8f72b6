"""Both speeds end at the same bits: ``pytest tests/optional/fast/test_same_bits.py --count 2000``.

Random steps are hard to prove: ties, rows that depend on each other, equal groups, loads and gaps
of sizes from 2^-300 to 2^300. What both speeds say of a step must also hold in fractions, without
the package. (Not of facets, whose corners the program in few lines rounds otherwise.)
"""

from fractions import Fraction

import pytest

from quasistatic_ref import StepIllPosed, StepInfeasible, solve_step
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solver import solver_for
from tests.oracles.degenerate_steps import degenerate_step
from tests.oracles.random_steps import designed_step, equal_groups
from tests.oracles.rational_kkt import exact, proved_optimum
from tests.oracles.solution_truth import nearest_float, program, proof

CLAIMS = ("active", "multipliers_unique", "differentiable", "smallest_inactive_slack")
"""What of a certificate is unique where the multipliers are; the others always are."""


def outcome(step, solver):
    """What is unique of a step's solution; of a step that is refused, the error."""
    try:
        solution = solve_step(step, solver)
    except (StepInfeasible, StepIllPosed) as refused:
        return refused
    certificate = solution.certificate
    first = 0 if certificate.multipliers_unique else 1
    unique = [solution.delta_q, solution.net_impulse]
    if certificate.multipliers_unique:
        unique += [solution.lam, solution.lam_extra]
    claims = [bits(getattr(certificate, name)) for name in CLAIMS[first:]]
    return solution, bits(tuple(unique)), claims


def check(step, solver):
    """Compare both speeds, and what they say with the truth."""
    plain, fast = outcome(step, NONE), outcome(step, solver)
    in_fractions = not step.cone.startswith("facets")
    if isinstance(plain, Exception):
        assert type(plain) is type(fast)
        if in_fractions and isinstance(plain, StepInfeasible):
            assert all(proof(step, exact(one.farkas.exact)) for one in (plain, fast))
        return
    assert fast[1:] == plain[1:]
    if not in_fractions:
        return
    solution = fast[0]
    lam = [*solution.lam, *solution.lam_extra]
    working = [i for i, value in enumerate(lam) if value > 0]
    of = program(step)
    x, lam_w, _ = proved_optimum(of, working)
    assert [nearest_float(v) for v in x] == solution.delta_q.tolist()
    assert [nearest_float(v) for v in lam_w] == [lam[i] for i in working]
    assert all(v > Fraction(0) for v in lam_w)


@pytest.mark.extra("fast")
@pytest.mark.parametrize("make", [designed_step, degenerate_step])
def test_random_steps(make, count):
    for seed in range(100_000, 100_000 + count):
        step = make(seed)
        check(step, solver_for(step, "daqp", fast=True))


@pytest.mark.extra("fast")
def test_one_solver_takes_equal_groups_that_differ_in_all_else(rng):
    """Three steps of one kind after the other, as in a run."""
    for _ in range(20):
        step = equal_groups(rng)
        solver = solver_for(step, "daqp", fast=True)
        for factor in (1.0, 0.5, -1.0):
            step = step.replace(tau_u=factor * step.tau_u)
            check(step, solver)
