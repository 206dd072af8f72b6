"""Solution files of strange steps, against optima in fractions.

The package's exact method names a working set, on which the optimum is proved and rounded here.
"""

import json
from fractions import Fraction
from itertools import islice, pairwise

import numpy as np
import pytest

from quasistatic_ref import QuasistaticError, StepInfeasible, solve_step
from quasistatic_ref.certify.solution_files import infeasible_text, solution_text
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.files import step_text
from tests.helpers import verify_refusal
from tests.oracles.attacked_steps import steps
from tests.oracles.rational_kkt import proved_optimum
from tests.oracles.solution_truth import program, proof, weights, wrenches
from validation.check_solution import rounded

FAMILIES = ("all scales", "subnormal loads", "nearly singular")


def solution_file(step, backend, certify):
    """The solution file of a step; None where a sentence takes its place."""
    try:
        return solution_text(solve_step(step, backend, certify=certify))
    except StepInfeasible as error:
        return infeasible_text(step, error.farkas.exact)
    except QuasistaticError:
        return None


def right_file(step, record):
    """What of an exact solution file fractions decide, from the working set that it names."""
    starts = np.cumsum([0, *map(len, weights(step))]).tolist()
    working = [starts[j] + i for j, i in record["certificate"]["active"]]
    problem = program(step)
    x, lam_w, slack = proved_optimum(problem, working)
    lam = [0.0] * len(problem[3])
    for i, value in zip(working, lam_w, strict=True):
        lam[i] = rounded(value)
    by_contact = [lam[a:b] for a, b in pairwise(starts)]
    known = {"smallest_active_multiplier": min(map(rounded, lam_w), default=None)}
    if record["certificate"]["differentiable"]:
        positive = [rounded(s) for s in slack if s]
        known["smallest_inactive_slack"] = min(positive, default=None)
    return record | {
        "delta_q": [*map(rounded, x)],
        "lam": by_contact,
        "lam_extra": lam[starts[-1] :],
        "wrench": wrenches(step, by_contact),
        "certificate": record["certificate"] | known | {"error_bound": 0.0},
    }


@pytest.mark.parametrize("family", FAMILIES)
def test_an_exact_answer_is_that_of_fractions_and_verified(family, tmp_path):
    files = ((step, solution_file(step, "none", "full")) for step in steps(family))
    for step, text in islice(((s, t) for s, t in files if t is not None), 2):
        record = json.loads(text)
        if record["status"] == "infeasible":
            assert proof(step, record["farkas"])
        else:
            assert json.dumps(right_file(step, record)) == json.dumps(record)  # -0.0 is not 0.0
        assert verify_refusal(tmp_path, step_text(step), text) is None


def test_residuals_of_a_subnormal_answer_are_of_the_answer_as_given():
    """A mass of 3 kg in a second: x* = tau / 3, of which delta_q has no digit."""
    tau = 1e-323
    step = free_step(np.array([[3.0]]), np.array([tau]), no_contacts(1), 1.0)
    solution = solve_step(step, solver_for(step, "daqp", fast=True), certify="residual")
    off = abs(3 * Fraction(solution.delta_q[0]) - Fraction(tau))
    units = ScaledStep(step).units
    natural = off * Fraction(units.coordinate[0]) / Fraction(units.size)
    assert solution.certificate.residuals["stationarity"] == natural > 0
