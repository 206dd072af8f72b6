"""Answers that differ and are right, and their neighbours that are not."""

import pytest

from quasistatic_ref.lab.vectors.check.case import case_verdict, verdict_to_digits
from quasistatic_ref.lab.vectors.tables import ORIGIN, at
from tests.lab.vectors.committed_cases import cases, expected_of


def record(output, flags=None, **tolerance):
    """What is expected, with tolerances by field."""
    absolute = {name: {"absolute": value, "reason": ""} for name, value in tolerance.items()}
    return {"output": output, "flags": flags or {}, "tolerance": absolute, "digits": {}}


def judged(layer, case, wanted, **changes):
    """The verdict on what is expected, but for some fields."""
    return case_verdict(layer, case, wanted, wanted["output"] | changes)


def twice_the_same_row():
    """Min x^2/2 with the row x >= 1 given twice: lam_1 + lam_2 = 1, in any shares."""
    case = {"H": [[1.0]], "g": [0.0], "A": [[1.0], [1.0]], "b": [1.0, 1.0]}
    output = {"delta_q": [1.0], "lam": [1.0, 0.0], "A_lam": [1.0], "slack": [0.0, 0.0]}
    return case, record(output, {"unique_multipliers": False}, lam=1e-15, A_lam=1e-15)


@pytest.mark.parametrize(
    ("lam", "verdict"),
    [
        ([1.0, 0.0], "passed"),
        ([0.25, 0.75], "acceptable"),
        ([0.0, 1.0], "acceptable"),
        ([0.5, 0.4], "failed"),  # A'lam = 0.9
        ([1.5, -0.5], "failed"),  # below 0
    ],
)
def test_multipliers_that_are_not_unique_count_by_what_they_do(lam, verdict):
    assert judged("qp", *twice_the_same_row(), lam=lam).verdict == verdict


def test_unique_multipliers_are_compared_by_component():
    case, wanted = twice_the_same_row()
    wanted["flags"]["unique_multipliers"] = True
    assert judged("qp", case, wanted, lam=[0.25, 0.75]).field == "lam"


def test_a_multiplier_on_a_row_with_slack_is_wrong():
    case, wanted = twice_the_same_row()
    wanted["output"]["slack"] = [0.0, 1e-3]
    verdict = judged("qp", case, wanted, lam=[0.25, 0.75])
    assert verdict.verdict == "failed"
    assert "slack" in verdict.reason


# Three walls of a triangle that leave no room: y = (1, 1, 1) up to a factor, and 0 on a fourth row
# that repeats the first; then (1 - t, 1, 1, t) does as well, but its largest entry must be 1.
WALLS = {
    "H": [[1.0, 0.0], [0.0, 1.0]],
    "g": [0.0, 0.0],
    "A": [[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0], [1.0, 0.0]],
    "b": [1.0, 1.0, 1.0, 1.0],
}


@pytest.mark.parametrize(
    ("y", "verdict"),
    [
        ([1.0, 1.0, 1.0, 0.0], "passed"),
        (["1", "1", "1", "0"], "passed"),
        (["1/3", "1", "1", "2/3"], "acceptable"),
        (["1/3", "1", "1", "333/500"], "failed"),  # fractions have to add up
        ([2.0, 2.0, 2.0, 0.0], "failed"),
        (["1", "2/3", "2/3", "-1/3"], "failed"),
        ([1.0, 1.0, 1.0], "failed"),
        (["1", "1", "1", "1/0"], "failed"),
        ([1.0, 1.0, 1.0, float("nan")], "failed"),
    ],
)
def test_another_proof_that_there_is_no_solution_is_checked_exactly(y, verdict):
    wanted = record({"farkas": [1.0, 1.0, 1.0, 0.0]}, {"infeasible": True}, farkas=1e-9)
    assert judged("qp", WALLS, wanted, farkas=y).verdict == verdict


def test_a_contradiction_below_rounding_need_not_be_seen():
    # x >= 1/2 + 2^-52 and x <= 1/2.
    case = {"H": [[1.0]], "g": [0.0], "A": [[1.0], [-1.0]], "b": [0.5 + 2.0**-52, -0.5]}
    wanted = record({"farkas": [1.0, 1.0]}, {"infeasible": True}, farkas=1e-9)
    for x, verdict in ((0.5, "acceptable"), (0.5 + 1e-9, "failed")):
        answer = {"delta_q": [x], "lam": [1.0, 0.5]}
        assert case_verdict("qp", case, wanted, answer).verdict == verdict


@pytest.mark.parametrize(
    ("chosen", "verdict"),
    [
        ([2, 0], "passed"),
        ([2, 1], "failed"),
        ([0, 2], "failed"),  # not the nearest first
        ([2], "failed"),
    ],
)
def test_equal_distances_stand_in_the_order_of_their_places(chosen, verdict):
    case = {"phi": [[0.2, 0.2, 0.1, 0.2, 0.3]], "k": 2}
    wanted = record({"indices": [[2, 0]]}, {"tie": True})
    assert judged("selection", case, wanted, indices=[chosen]).verdict == verdict


LEVEL, STEEP = [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]
NORMALS = [LEVEL, STEEP, LEVEL, LEVEL, STEEP, LEVEL]  # acos 0.8 is more than 0.25 rad
# Places 0, 2, 3 and 5 are left, of which the distances of 2 and 3 differ in the eighth digit; the
# fifth is the one after the last, 6.
FILLED = {"phi": [[0.4, 0.1, 0.1, 0.1 + 1e-9, 0.2, 0.3]], "normals": [NORMALS], "k": 5}


@pytest.mark.parametrize(
    ("chosen", "digits", "words"),
    [
        ([2, 3, 5, 0, 6], None, ""),
        ([3, 2, 5, 0, 6], 6, ""),
        ([3, 2, 5, 0, 6], None, "indices[0][0] is off by 1"),
        ([2, 1, 5, 0, 6], 6, "indices[0][1] is 1: its normal is more than 0.25 rad from"),
        ([2, 3, 5, 0, 7], 6, "indices[0][4] is 7: indices must be whole numbers from 0 to 6"),
        ([2, 3, 2, 0, 6], 6, "indices[0][2] is 2: it stands there twice"),
    ],
)
def test_a_selection_with_normals_may_be_another_and_a_wrong_index_is_named(chosen, digits, words):
    wanted = record({"indices": [[2, 3, 5, 0, 6]]})
    verdict = verdict_to_digits("selection", FILLED, wanted, {"indices": [chosen]}, digits)
    assert (verdict.verdict == "failed") == bool(words)
    assert words in verdict.reason


def boxes_face_to_face():
    """Unit cubes 1 m apart along x: any point of the facing squares is a witness."""
    box = {"kind": "box", "size": [1.0, 1.0, 1.0]}
    case = {"alpha": box, "beta": box, "pose_alpha": ORIGIN, "pose_beta": at(2.0, 0.25, 0.0)}
    output = {"phi": 1.0, "alpha": [0.5, 0.0, 0.0], "beta": [1.5, 0.0, 0.0], "n": [1.0, 0.0, 0.0]}
    fields = dict.fromkeys(("phi", "alpha", "beta", "n"), 1e-14)
    return case, record(output, {"unique": False}, **fields)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, "passed"),
        ({"alpha": [0.5, 0.3, -0.4], "beta": [1.5, 0.3, -0.4]}, "acceptable"),
        ({"alpha": [0.5, 0.6, 0.0], "beta": [1.5, 0.6, 0.0]}, "failed"),  # outside of alpha's box
        ({"alpha": [0.4, 0.0, 0.0], "beta": [1.4, 0.0, 0.0]}, "failed"),  # inside it
        ({"n": [0.0, 1.0, 0.0]}, "failed"),
        ({"phi": 1.1}, "failed"),
    ],
)
def test_another_witness_has_to_prove_the_distance(changes, verdict):
    assert judged("distance", *boxes_face_to_face(), **changes).verdict == verdict


@pytest.mark.parametrize(("y", "verdict"), [(1e-13, "failed"), (0.3, "acceptable")])
def test_near_a_unique_witness_there_is_no_other(y, verdict):
    # Unique is said of exact numbers: a face that is parallel but for 1e-18 has one nearest corner.
    case, wanted = boxes_face_to_face()
    wanted["flags"]["unique"] = True
    moved = judged("distance", case, wanted, alpha=[0.5, y, 0.0], beta=[1.5, y, 0.0])
    assert moved.verdict == verdict


def case_of_joints(layer, kind):
    """The first case of a layer all of whose joints are of one kind."""
    for case in cases(layer):
        if {body["joint"] for body in case.input["mechanism"]["bodies"]} == {kind}:
            return case
    raise LookupError(kind)


@pytest.mark.parametrize(
    ("layer", "field", "kind", "turn", "verdict"),
    [
        ("integrate", "q", "floating", slice(3, 7), "acceptable"),
        ("step", "q_next", "floating", slice(3, 7), "acceptable"),
        ("integrate", "q", "continuous", slice(0, 2), "failed"),
    ],
)
def test_minus_q_is_q_but_minus_cos_sin_is_not(layer, field, kind, turn, verdict):
    case = case_of_joints(layer, kind)
    wanted = expected_of(layer)[case.id]
    q = list(wanted["output"][field])
    q[turn] = [-x for x in q[turn]]
    assert judged(layer, case.input, wanted, **{field: q}).verdict == verdict
