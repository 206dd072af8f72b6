"""Contacts of a brick on a box where rounding decides which points are closest."""

import copy

import pytest

from quasistatic_ref.lab.vectors.tables import free_body, on, scene
from tests.lab.vectors.committed_cases import record_of, verdict_of

ABOUT_X = (0.1, 0.0, 0.0, 1.0)
ABOUT_Y = (0.0, 0.2, 0.0, 1.0)


def brick(turn, k):
    """A step of a brick whose faces or edges are parallel to a box's face; what is expected."""
    shapes = {
        "body": on("object", {"kind": "box", "size": [0.09, 0.06, 0.09]}),
        "under": on(None, {"kind": "box", "size": [0.1, 0.2, 0.1]}),
    }
    pair = {"name": "stack", "alpha": "body", "beta": "under", "mu_v": 1.0, "mu_omega": 0.0}
    pairs = [pair | {"rows": 6, "k": k}]
    case = scene([free_body()], shapes, [0.03, 0.01, 0.1, *turn], pairs=pairs)
    return case, record_of("step", case)


# With 5 contacts there are as many candidates or more; with 8 the closest pair fills the number.
@pytest.mark.parametrize("turn", [(ABOUT_X, 8), (ABOUT_Y, 5)])
def test_package_and_plain_program_are_right_by_the_same_rules(turn):
    _, record = brick(*turn)
    assert record is not None


@pytest.mark.parametrize(
    ("index", "changes", "words"),
    [
        (17, {"phi": 0.005}, "the distances of stack are others"),
        (17, {"alpha": [0.03, 0.01, 0.2]}, "stack/17: beta - alpha is not phi n"),
        (38, {"alpha": [0.0, 0.0, 0.06]}, "stack/38: its alpha is another"),
        (38, {"index": 40}, "stack has no candidate 40"),
    ],
)
def test_a_contact_that_is_no_crossing_and_does_not_fill_is_refused(index, changes, words):
    case, record = brick((0.0, 0.0, 0.0, 1.0), 8)
    output = copy.deepcopy(record["output"])
    (wrong,) = (contact for contact in output["contacts"] if contact["index"] == index)
    wrong |= changes
    assert words in verdict_of("step", case, record, output).reason
