"""Layer `derivative`: against float64 differences of the plain program; kinks, and mistakes."""

import numpy as np
import pytest

from quasistatic_ref.lab.program import step
from quasistatic_ref.lab.program.candidates import tangents
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.mistakes import MISTAKES
from quasistatic_ref.lab.vectors.converters import tangent_map
from quasistatic_ref.lab.vectors.layers import layer
from tests.lab.vectors.material import cases, expected, report_on
from tests.lab.vectors.slopes import EPS, by_q, coordinates, held, minus, q_next, rate, slopes

CHECKED = ("ball/pyramid", "forces/turned", "arm/passive_elbow", "planar/push",
           "mimic/revolute_actuated", "pair/sphere_ellipsoid_1", "pair/cylinder_box_0")  # fmt: skip
"""Rolling, sliding, driven, followed; curved surfaces and flat ones."""
CURVED = ("pair/ellipsoid_sphere_2", "pair/capsule_sphere_2")
"""Smooth contacts of round surfaces, pressed: every mistake about contacts shows."""
FLOAT64 = 1e-6
"""Of the largest entry: differences over 1e-5 of numbers of 1e-16, with a condition up to 1e4."""


def case_of(name):
    return next(case for case in cases("derivative") if case.id == f"derivative/{name}")


def output_of(name):
    return expected("derivative")[f"derivative/{name}"]["output"]


def kinks():
    return [case for case in cases("derivative") if "/kink/" in case.id]


@pytest.mark.parametrize("name", CHECKED)
def test_differences_in_float64_are_the_same(name):
    wanted = np.array(output_of(name)["dq_dq"])
    found = slopes(case_of(name).input)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=FLOAT64 * np.abs(wanted).max())


def test_there_are_three_hundred_cases_and_kinks_of_every_kind():
    found = cases("derivative")
    assert len(found) >= 300
    named = [{r["kind"] for r in expected("derivative")[case.id]["output"]["reasons"]}
             for case in kinks()]  # fmt: skip
    assert [{case.id.split("/")[2]} for case in kinks()] == named
    kinds = [kind for one in named for kind in one]
    for kind in ("row", "selection", "feature", "tangents", "touching", "multipliers"):
        assert kinds.count(kind) >= 6


def test_kinks_without_rounding_are_found_anew_by_kind_and_name():
    for case in kinks()[::9]:
        found = layer("derivative").expected(case.input)
        assert found.output == expected("derivative")[case.id]["output"]


def test_one_sided_differences_of_another_program_differ_at_kinks():
    names = ("row/landing_pyramid", "row/beside", "selection/cloud_two_in", "multipliers/bar_1")
    for name in names:
        case = held(case_of(f"kink/{name}").input)
        start = q_next(case)
        jumps = []
        for j in range(coordinates(case)):
            up, down = (minus(case, q_next(by_q(case, j, s * EPS)), start) for s in (1, -1))
            jumps.append(np.abs(up + down).max() / EPS)
        assert max(jumps) > 1e-3, name


def verdict(name, answer):
    case = case_of(name)
    return case_verdict("derivative", case.input, expected("derivative")[case.id], answer)


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
        {**right, "dq_dx": 1.0},
        {"differentiable": False, "reasons": []},
        None,
    ):
        assert verdict(name, wrong).verdict == "failed"


def test_no_derivative_is_acceptable_where_a_part_switches():
    records = expected("derivative").items()
    names = [id for id, r in records if r["flags"]["switch"] and r["output"]["differentiable"]]
    assert names
    for id in names:
        answer = {"differentiable": False, "reasons": []}
        assert verdict(id.partition("/")[2], answer).verdict == "acceptable"


def contacts_taken(change):
    """Derivatives of a step whose contacts are changed, given what they were at q."""

    def answer(case, monkeypatch):
        right = step.contacts_of
        start = right(case, kinematics(case["mechanism"], np.array(case["q"])))
        before = kinematics(case["mechanism"], np.array(case["q"]))

        def wrong(other, at):
            return [
                {**one, **change(own, one, before, at)}
                for own, one in zip(start, right(other, at), strict=True)
            ]

        with monkeypatch.context() as patch:
            patch.setattr(step, "contacts_of", wrong)
            return slopes(case)

    return answer


def carried(own, before, at, side):
    (R, t, _), (R_now, t_now, _) = before[own[f"{side}_body"]], at[own[f"{side}_body"]]
    return R_now @ R.T @ (own[side] - t) + t_now


def framed(n):
    d1, d2 = tangents(n)
    return {"n": n, "d1": d1, "d2": d2}


def frozen(own, one, before, at):
    return framed(own["n"])


def material(own, one, before, at):
    return {side: carried(own, before, at, side) for side in ("alpha", "beta")}


def beta_flat(own, one, before, at):
    body = own["beta_body"]
    return framed(at[body][0] @ before[body][0].T @ own["n"])


def in_the_world(case, monkeypatch):
    B, after = (tangent_map(case["mechanism"], q, "world") for q in (case["q"], q_next(case)))
    return after.T @ slopes(case) @ B


def summed(case, monkeypatch):
    case = held(case)

    def delta_q(j, by):
        moved = by_q(case, j, by)
        return minus(moved, q_next(moved), np.array(moved["q"]))

    rates = [rate(lambda by, j=j: delta_q(j, by)) for j in range(coordinates(case))]
    return np.eye(len(rates)) + np.column_stack(rates)


PLANTED = {
    "normal frozen": contacts_taken(frozen),
    "contact point taken as material": contacts_taken(material),
    "curvature of one body only": contacts_taken(beta_flat),
    "derivative in the world instead of the body frame": in_the_world,
    "(+) not differentiated": summed,
}


@pytest.mark.parametrize("mistake", PLANTED)
def test_a_planted_mistake_is_found_and_named(mistake, monkeypatch):
    answers = {}
    for name in CURVED:
        case = case_of(name)
        D = PLANTED[mistake](case.input, monkeypatch)
        answers[case.id] = {"differentiable": True, "dq_dq": D.tolist()}
    report = report_on("derivative", answers)
    assert report.count("failed") == len(answers)
    assert [named.name for named in report.mistakes] == [mistake]


@pytest.mark.parametrize(
    ("mistake", "wanted"),
    [
        ("sub-gradient at a tie", lambda kind: kind != "multipliers"),
        ("sensitivity of a multiplier that is not unique", lambda kind: kind == "multipliers"),
    ],
)
def test_numbers_at_a_kink_are_found_and_named(mistake, wanted):
    chosen = [case for case in kinks() if wanted(case.id.split("/")[2])]
    zeros = {"differentiable": True, "reasons": [], "dq_dq": [[0.0]]}
    report = report_on("derivative", {case.id: zeros for case in chosen})
    assert report.count("failed") == len(chosen)
    assert [named.name for named in report.mistakes] == [mistake]


def test_every_mistake_about_derivatives_is_planted():
    known = {one.name for one in MISTAKES if set(one.predictions) == {"derivative"}}
    planted = {*PLANTED, "sub-gradient at a tie", "sensitivity of a multiplier that is not unique"}
    assert known == planted
