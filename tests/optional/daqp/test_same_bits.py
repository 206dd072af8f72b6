"""Both speeds end at the same bits: ``pytest tests/optional/daqp/test_same_bits.py --count 2000``.

Random steps are hard to prove: ties, rows that depend on each other, equal groups, loads and gaps
of sizes from 2^-300 to 2^300.
Of vectors and of the answers of contact-qp, a share is taken that grows with ``--count``. Whole
runs have the hashes that validation/results/run_hashes.md lists.
"""

import hashlib
import re

import pytest

from quasistatic_ref import StepIllPosed, StepInfeasible, load_scenario, solve_step
from quasistatic_ref.lab.folders import contact_qp_folder
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.problem import EXACT
from quasistatic_ref.lab.vectors.layers.qp import step_of
from tests.extras import SCENARIOS
from tests.lab.vectors.committed_cases import cases
from tests.made import bits
from tests.oracles.random_steps import POLYHEDRAL, drawn
from tests.pages import ROOT
from tests.solvers import NONE, solver_for

CLAIMS = ("multipliers_unique", "differentiable", "smallest_inactive_slack")
"""What of a certificate is always unique; the active rows are where the multipliers are."""
KINDS = ("small", "body copies rows", "small integers", "small classes rows")


def outcome(step, solver):
    """What is unique of a step's solution; of a step that is refused, the error."""
    try:
        solution = solve_step(step, solver)
    except (StepInfeasible, StepIllPosed) as refused:
        return refused
    unique = [solution.delta_q, solution.net_impulse]
    unique += [getattr(solution.certificate, name) for name in CLAIMS]
    if solution.certificate.multipliers_unique:
        unique += [solution.lam, solution.certificate.active]
    return solution, bits(unique)


def outcomes(step, solver=None):
    """What both speeds end with, plain first: the same bits, or errors of one class."""
    solver = solver or solver_for(step, "daqp")
    plain, fast = outcome(step, NONE), outcome(step, solver)
    assert type(plain) is type(fast)
    assert isinstance(plain, Exception) or fast[1] == plain[1]
    return plain, fast


def test_random_steps(count):
    for seed in range(100_000, 100_000 + 2 * count):
        step = drawn(seed, KINDS[seed % len(KINDS)] + " powers")
        outcomes(step.replace(cone=POLYHEDRAL[seed % len(POLYHEDRAL)]))


def kept_of(items, count):
    """A share of some items: all of them from a count of 2000 on."""
    return items[:: max(1, 2000 // count)]


def test_programs_of_the_vectors(count):
    linear = [case.input for case in cases("qp") if "second_order" not in case.input]
    for program_of_case in kept_of(linear, count):
        outcomes(step_of(program_of_case))


def test_answers_of_contact_qp(count):
    """Of those that are proved exactly, of up to 60 coordinates."""
    members = set_read(contact_qp_folder())
    exact_ones = [one for one in members if one.answer.kind == EXACT and len(one.g) <= 60]
    for one in kept_of(exact_ones, count):
        numbers = {"H": one.H.toarray(), "g": one.g, "A": one.A.toarray(), "b": one.b}
        plain, _ = outcomes(step_of({name: array.tolist() for name, array in numbers.items()}))
        if one.answer.farkas:
            assert isinstance(plain, StepInfeasible)
        else:
            assert bits(plain[0].delta_q) == bits(one.answer.x + 0.0)


@pytest.mark.long
@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize("name", SCENARIOS)
def test_whole_runs_have_their_hashes(name, fast):
    page = (ROOT / "validation/results/run_hashes.md").read_text("utf-8")
    known = dict(re.findall(r"^\| (\w+) \| `(\w{64})` \|$", page, re.MULTILINE))
    run = load_scenario(name, ["record=light"], fast=fast).run()
    assert hashlib.sha256(run["q"].tobytes()).hexdigest() == known[name]


def test_one_solver_takes_equal_groups_that_differ_in_all_else(rng):
    """Three steps of one kind after the other, as in a run."""
    for _ in range(20):
        step = drawn(rng, "body copies rows")
        solver = solver_for(step, "daqp")
        for factor in (1.0, 0.5, -1.0):
            step = step.replace(tau_u=factor * step.tau_u)
            outcomes(step, solver)
