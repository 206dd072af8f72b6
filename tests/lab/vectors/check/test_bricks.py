"""Contacts of a brick on a box where rounding decides which points are closest, and tangents."""

import copy
import functools

import numpy as np
import pytest

from quasistatic_ref.lab.program import step as program
from quasistatic_ref.lab.vectors.challenge.fresh import record_of
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.own_contacts import contacts_problem
from quasistatic_ref.lab.vectors.own.step import own_step
from quasistatic_ref.lab.vectors.tables import free_body, on, scene
from quasistatic_ref.lab.vectors.trees import mapped

LEVEL = (0.0, 0.0, 0.0, 1.0)
ABOUT_X = (0.1, 0.0, 0.0, 1.0)
ABOUT_Y = (0.0, 0.2, 0.0, 1.0)


@functools.cache
def brick(turn, aside, k):
    """A step of a brick whose faces or edges are parallel to a box's face; what is expected."""
    shapes = {
        "body": on("body", {"kind": "box", "size": [0.09, 0.06, 0.09]}),
        "under": on(None, {"kind": "box", "size": [0.1, 0.2, 0.1]}),
    }
    pair = {"name": "stack", "alpha": "body", "beta": "under", "mu_v": 1.0, "mu_omega": 0.0}
    body = {**free_body("body"), "mass": 1.0, "com": [0.0] * 3, "inertia": np.eye(3).tolist()}
    case = scene([body], shapes, [aside, 0.01, 0.1, *turn], pairs=[pair | {"rows": 6, "k": k}])
    return case, record_of("step", case)


def answer_of(step, case):
    return mapped(step(case), lambda x: x.tolist() if isinstance(x, np.ndarray) else x)


# With 5 contacts there are as many candidates or more; with 8 the closest pair fills the number.
@pytest.mark.parametrize("brick_of", [(LEVEL, 0.03, 8), (ABOUT_X, 0.03, 8), (ABOUT_Y, 0.03, 5)])
@pytest.mark.parametrize("step", [program.step, own_step])
def test_other_closest_points_are_right_of_corners_crossings_and_filling(step, brick_of):
    case, record = brick(*brick_of)
    verdict = case_verdict("step", case, record, answer_of(step, case))
    assert verdict.verdict in ("passed", "acceptable"), verdict.reason


@pytest.mark.parametrize(
    ("index", "changes", "words"),
    [
        (17, {"phi": 0.005}, "the distances of stack are others"),
        (17, {"alpha": [0.03, 0.01, 0.2]}, "stack/17: beta - alpha is not phi n"),
        (38, {"alpha": [0.0, 0.0, 0.06]}, "stack/38: its alpha is another"),
        (38, {"index": 40}, "stack has no candidate 40"),
    ],
)
def test_what_is_no_crossing_and_does_not_fill_is_refused(index, changes, words):
    case, record = brick(LEVEL, 0.03, 8)
    contacts = copy.deepcopy(record["output"]["contacts"])
    (wrong,) = (contact for contact in contacts if contact["index"] == index)
    wrong |= changes
    assert words in contacts_problem(case, record, contacts)
