"""The layer `step` and its parts: candidates, joints that follow another."""

import numpy as np
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.candidates import chosen
from quasistatic_ref.lab.vectors.families.scenario_mechanism import mechanism_of, pairs_of
from quasistatic_ref.scenario.scenario import load_scenario
from tests.lab.vectors.material import cases, expected
from tests.tolerances import ROUNDING

HERE = {"xyz": [0.0, 0.0, 0.0], "quaternion": [0.0, 0.0, 0.0, 1.0]}
FLOOR = {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
BOX = {"kind": "box", "size": [0.2, 0.2, 0.2]}


def test_a_box_on_a_floor_keeps_its_lower_corners_in_order():
    pose = {"xyz": [0.0, 0.0, 0.25], "quaternion": [0.01, 0.02, 0.0, 1.0]}
    found = chosen(FLOOR, BOX, HERE, pose, 4)
    assert [contact["index"] for contact in found.contacts] == [0, 1, 2, 3]  # z < 0; x first
    assert found.clear
    assert found.unique


def test_a_closest_pair_comes_after_corners_that_are_as_near():
    nearly_level = {"xyz": [0.0, 0.0, 0.25], "quaternion": [1e-10, 0.0, 0.0, 1.0]}
    found = chosen(FLOOR, BOX, HERE, nearly_level, 4)  # the lower edge is 4e-11 m nearer
    assert [contact["index"] for contact in found.contacts] == [0, 1, 2, 3]
    assert found.clear


def test_where_rounding_decides_what_is_kept_it_is_said():
    level = {"xyz": [0.0, 0.0, 0.25], "quaternion": [0.0, 0.0, 0.0, 1.0]}
    assert chosen(FLOOR, BOX, HERE, level, 4).clear  # exact ties: by index
    assert chosen(FLOOR, BOX, HERE, level, 2).clear is False
    tilted = {**level, "quaternion": [0.1, 0.0, 0.0, 1.0]}  # an edge is parallel to the floor
    assert chosen(FLOOR, BOX, HERE, tilted, 1).unique is False
    assert chosen(FLOOR, BOX, HERE, tilted, 3).clear is False


def test_corners_that_depend_on_the_other_solid_make_one_contact_only():
    with pytest.raises(InputError, match="use k = 1"):
        chosen(FLOOR, {"kind": "cylinder", "radius": 0.1, "length": 0.2}, HERE, HERE, 2)


def test_a_step_of_a_scenario_is_that_of_the_simulator():
    scenario = load_scenario("bunny_grasp", fast=True)
    shapes, pairs = pairs_of(scenario)
    (case,) = (case for case in cases("step") if case.id == "step/bunny_grasp/0")
    assert case.input["mechanism"] == mechanism_of(scenario)
    assert (case.input["shapes"], case.input["pairs"]) == (shapes, pairs)
    q = scenario.system.q_start
    result = scenario.simulator().step(q, scenario.targets(scenario.h))
    output = expected("step")[case.id]["output"]
    size = np.abs(result.solution.delta_q).max()
    np.testing.assert_allclose(
        output["delta_q"], result.solution.delta_q, rtol=0, atol=ROUNDING * size
    )
    np.testing.assert_allclose(output["q_next"], result.q, rtol=0, atol=ROUNDING)


def test_consecutive_steps_of_a_run_follow_each_other():
    by_id = {case.id: case.input for case in cases("step")}
    after = expected("step")["step/stack/15"]["output"]["q_next"]
    np.testing.assert_allclose(after, by_id["step/stack/16"]["q"], rtol=0, atol=ROUNDING)
