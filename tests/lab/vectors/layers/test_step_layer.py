"""The layer `step` and its parts: candidates, joints that follow another."""

import numpy as np

from quasistatic_ref import contact_forces, load_scenario
from quasistatic_ref.lab.vectors.own.step import posed_case, with_compliance
from tests.closeness import assert_within
from tests.helpers import first_step
from tests.lab.vectors.committed_cases import expected_of, inputs_of, own_answer, verdict_on
from tests.tolerances import ROUNDING


def test_a_step_of_a_scenario_is_that_of_the_simulator():
    result = first_step(load_scenario("bunny_grasp", fast=True))
    output = expected_of("step")["step/bunny_grasp/0"]["output"]
    size = np.abs(result.solution.delta_q).max()
    assert_within(output["delta_q"], result.solution.delta_q, ROUNDING * size)
    assert_within(output["q_next"], result.q)


STACK = "step/stack/0"
"""A step of boxes on each other, whose optimal lam are many."""


def test_other_optimal_lam_stand_with_the_same_forces():
    record = expected_of("step")[STACK]
    own = own_answer("step", inputs_of(STACK))
    assert record["flags"]["unique_multipliers"] is False
    assert own["lam"] != record["output"]["lam"]
    assert verdict_on(STACK, own).verdict == "acceptable"
    assert verdict_on(STACK, own | {"forces": own["wrench"]}).field == "forces"


def test_the_compliance_of_a_case_is_2_18_times_a_run_s():
    case = inputs_of("step/cloud/on_an_edge")
    posed = posed_case(case)
    (pair,) = with_compliance(case)["pairs"]
    assert pair["compliance"] == 2.0**18 * contact_forces(posed.step).compliance[0]
