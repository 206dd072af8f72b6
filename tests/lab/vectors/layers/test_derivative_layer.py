"""Verdicts on answers of the layer `derivative`: numbers, kinks, and reasons."""

from quasistatic_ref.lab.vectors.check.case import case_verdict
from tests.lab.vectors.committed_cases import cases, expected_of, report_on


def case_of(name):
    return next(case for case in cases("derivative") if case.id == f"derivative/{name}")


def output_of(name):
    return expected_of("derivative")[f"derivative/{name}"]["output"]


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
