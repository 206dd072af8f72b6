"""Layer `derivative`: against float64 differences of the plain program, and its kinks."""

import numpy as np
import pytest

from quasistatic_ref.lab.program.derivative import EPS, case_with_tau, derivative
from quasistatic_ref.lab.program.integration import integrate, way
from quasistatic_ref.lab.program.step import step
from quasistatic_ref.lab.vectors.check.case import case_verdict
from tests.closeness import assert_within
from tests.lab.vectors.committed_cases import cases, expected_of, report_on

CHECKED = ("ball/pyramid", "forces/turned", "arm/passive_elbow", "planar/push",
           "mimic/revolute_actuated", "pair/sphere_ellipsoid_1", "pair/cylinder_box_0")  # fmt: skip
"""Rolling, sliding, driven, followed; curved surfaces and flat ones."""
FLOAT64 = 1e-6
"""Of the largest entry: differences over 1e-5 of numbers of 1e-16, with a condition up to 1e4."""


def q_next(case):
    return np.array(step(case)["q_next"])


def case_of(name):
    return next(case for case in cases("derivative") if case.id == f"derivative/{name}")


def output_of(name):
    return expected_of("derivative")[f"derivative/{name}"]["output"]


@pytest.mark.parametrize("name", CHECKED)
def test_differences_in_float64_are_the_same(name):
    wanted = np.array(output_of(name)["dq_dq"])
    found = derivative(case_of(name).input)["dq_dq"]
    assert_within(found, wanted, FLOAT64 * np.abs(wanted).max())


@pytest.mark.parametrize(
    "name", ["row/landing_pyramid", "row/beside", "selection/cloud_two_in", "multipliers/bar_1"]
)
def test_one_sided_differences_of_another_program_differ_at_kinks(name):
    case = case_with_tau(case_of(f"kink/{name}").input)
    start = q_next(case)
    jumps = []
    for e in np.eye(len(way(case["mechanism"], start, start))):
        places = (integrate({**case, "delta_q": s * EPS * e})["q"] for s in (1, -1))
        up, down = (way(case["mechanism"], start, q_next({**case, "q": q})) for q in places)
        jumps.append(np.abs(up + down).max() / EPS)
    assert max(jumps) > 1e-3


def verdict(name, answer):
    case = case_of(name)
    return case_verdict("derivative", case.input, expected_of("derivative")[case.id], answer)


def test_a_verdict_needs_the_kind_and_the_name():
    name = "kink/row/limit_x"
    (reason,) = output_of(name)["reasons"]

    def said(*reasons):
        return verdict(name, {"differentiable": False, "reasons": list(reasons)}).verdict

    assert said(reason) == "passed"
    assert said(reason, {**reason, "kind": "feature", "rows": []}) == "acceptable"
    for other in ({"kind": "feature"}, {"rows": [0]}, {"pair": "wall"}, {"index": [1]}):
        assert said({**reason, **other}) == "failed"
    assert said() == said({}) == said("row") == "failed"
    partial = verdict(name, {"differentiable": False})
    assert (partial.verdict, partial.without) == ("passed", ("reasons",))
    assert verdict(name, {"differentiable": True}).field == "differentiable"


def test_numbers_may_be_answered_in_part_and_are_refused_where_wrong():
    name = "ball/pyramid"
    right = {"differentiable": True, "dq_dq": output_of(name)["dq_dq"]}
    assert "dq_dtau" in verdict(name, right).without
    assert verdict(name, right).verdict == "passed"
    for wrong in (
        {"differentiable": True},
        {"differentiable": "yes"},
        {**right, "dq_dq": right["dq_dq"][:-1]},
        {"differentiable": False, "reasons": []},
        None,
    ):
        assert verdict(name, wrong).verdict == "failed"


def test_no_derivative_is_acceptable_where_a_part_switches():
    records = expected_of("derivative").items()
    names = [id for id, r in records if r["flags"]["switch"] and r["output"]["differentiable"]]
    assert names
    for id in names:
        answer = {"differentiable": False, "reasons": []}
        assert verdict(id.partition("/")[2], answer).verdict == "acceptable"


def test_numbers_at_a_kink_are_found():
    zeros = {"differentiable": True, "reasons": [], "dq_dq": [[0.0]]}
    kinks = [case.id for case in cases("derivative") if "/kink/" in case.id]
    report = report_on("derivative", dict.fromkeys(kinks, zeros))
    assert report.count("failed") == len(kinks)
