"""The layer `step` and its parts: candidates, joints that follow another."""

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.own.step import posed_case
from tests.closeness import assert_within
from tests.helpers import first_step
from tests.lab.vectors.committed_cases import cases, expected_of, right_answers
from tests.oracles.compliant_forces import forces as independent_forces
from tests.tolerances import ROUNDING


def test_a_step_of_a_scenario_is_that_of_the_simulator():
    result = first_step(load_scenario("bunny_grasp", fast=True))
    output = expected_of("step")["step/bunny_grasp/0"]["output"]
    size = np.abs(result.solution.delta_q).max()
    assert_within(output["delta_q"], result.solution.delta_q, ROUNDING * size)
    assert_within(output["q_next"], result.q)


def case_of(name):
    """A case, what is expected of it, and that as an answer."""
    (case,) = (case for case in cases("step") if case.id == name)
    return case.input, expected_of("step")[name], right_answers("step")[name]


STACK = "step/stack/0"
"""A step of boxes on each other, whose optimal lam are many."""


def test_forces_are_those_that_fractions_prove_on_the_step_of_the_package():
    case, record, answer = case_of("step/cloud/tilted")
    found = independent_forces(posed_case(case).step, case["pairs"][0]["compliance"])
    allowed = record["tolerance"]["forces"]["absolute"]
    assert np.abs(found).max() > 1e4 * allowed
    assert_within(answer["forces"], found, allowed)


def test_other_optimal_lam_stand_with_the_same_forces():
    case, record, answer = case_of(STACK)
    own = layer("step").own(case)
    assert record["flags"]["unique_multipliers"] is False
    assert own["lam"] != answer["lam"]
    assert case_verdict("step", case, record, own).verdict == "acceptable"
    assert case_verdict("step", case, record, {**own, "forces": own["wrench"]}).field == "forces"
