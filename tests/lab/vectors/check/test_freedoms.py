"""Answers that differ and are right, and their neighbours that are not."""

import numpy as np
import pytest

from quasistatic_ref.lab.program.layers import LAYERS as PROGRAM
from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.converters import quaternion_places
from quasistatic_ref.lab.vectors.tables import ORIGIN, at
from tests.cases import first
from tests.lab.vectors.committed_cases import cases, expected_of, report_on

# Min x^2/2 with the row x >= 1 given twice: lam_1 + lam_2 = 1, in any shares.
TWICE = {"H": [[1.0]], "g": [0.0], "A": [[1.0], [1.0]], "b": [1.0, 1.0]}
SHARED = {"delta_q": [1.0], "lam": [1.0, 0.0], "A_lam": [1.0], "slack": [0.0, 0.0]}
# Three walls of a triangle that leave no room: y = (1, 1, 1) up to a factor, and 0 on a fourth row
# that repeats the first; then (1 - t, 1, 1, t) does as well, but its largest entry must be 1.
WALLS = {
    "H": [[1.0, 0.0], [0.0, 1.0]],
    "g": [0.0, 0.0],
    "A": [[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0], [1.0, 0.0]],
    "b": [1.0, 1.0, 1.0, 1.0],
}
# x >= 1/2 + 2^-52 and x <= 1/2.
NARROW = {"H": [[1.0]], "g": [0.0], "A": [[1.0], [-1.0]], "b": [0.5 + 2.0**-52, -0.5]}
EQUAL = {"phi": [[0.2, 0.2, 0.1, 0.2, 0.3]], "k": 2}
LEVEL, STEEP = [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]
NORMALS = [LEVEL, STEEP, LEVEL, LEVEL, STEEP, LEVEL]  # acos 0.8 is more than 0.25 rad
# Places 0, 2, 3 and 5 are left, of which the distances of 2 and 3 differ in the eighth digit; the
# fifth is the one after the last, 6.
FILLED = {"phi": [[0.4, 0.1, 0.1, 0.1 + 1e-9, 0.2, 0.3]], "normals": [NORMALS], "k": 5}
# Unit cubes 1 m apart along x: any point of the facing squares is a witness.
CUBE = {"kind": "box", "size": [1.0, 1.0, 1.0]}
APART = {"alpha": CUBE, "beta": CUBE, "pose_alpha": ORIGIN, "pose_beta": at(2.0, 0.25, 0.0)}
FACING = {"phi": 1.0, "alpha": [0.5, 0.0, 0.0], "beta": [1.5, 0.0, 0.0], "n": [1.0, 0.0, 0.0]}

PLANTED = {
    "twice": ("qp", TWICE, SHARED, {"unique_multipliers": False}),
    "unique": ("qp", TWICE, SHARED, {"unique_multipliers": True}),
    "off a row": ("qp", TWICE, SHARED | {"slack": [0.0, 1e-3]}, {"unique_multipliers": False}),
    "no room": ("qp", WALLS, {"farkas": [1.0, 1.0, 1.0, 0.0]}, {}),
    "narrow": ("qp", NARROW, {"farkas": [1.0, 1.0]}, {}),
    "equal": ("selection", EQUAL, {"indices": [[2, 0]]}, {}),
    "filled": ("selection", FILLED, {"indices": [[2, 3, 5, 0, 6]]}, {}),
    "squares": ("distance", APART, FACING, {"unique": False}),
    # Unique is said of exact numbers: a face that is parallel but for 1e-18 has one nearest corner.
    "one corner": ("distance", APART, FACING, {"unique": True}),
}
"""Layer, case, what is expected, flags."""
TOLERANCES = {"farkas": 1e-9, "lam": 1e-15, "A_lam": 1e-15} | dict.fromkeys(FACING, 1e-14)
RIGHT = ("other ", "another ", "a contradiction ", "right to ")
"""How reasons of acceptable answers begin."""


def higher(y):
    """The witness at another height of the facing squares."""
    return {"alpha": [0.5, y, 0.0], "beta": [1.5, y, 0.0]}


def judged(planted, changes, digits=None):
    """The verdict on what is expected, but for some fields; those that are None are left out."""
    layer, case, expected, flags = PLANTED[planted]
    tolerance = {name: {"absolute": TOLERANCES.get(name, 0.0)} for name in expected}
    record = {"output": expected, "flags": flags, "tolerance": tolerance}
    answer = {name: value for name, value in (expected | changes).items() if value is not None}
    return verdict_to_digits(layer, case, record, answer, digits)


@pytest.mark.parametrize("planted", PLANTED)
def test_the_expected_answer_passes(planted):
    assert judged(planted, {}).verdict == "passed"


ANSWERS = [
    ("twice", {"lam": [0.25, 0.75]}, "other multipliers with the same A'lam"),
    ("twice", {"lam": [0.0, 1.0]}, "other multipliers with the same A'lam"),
    ("twice", {"lam": [0.5, 0.4]}, "A'lam is off by 0.1"),
    ("twice", {"lam": [1.5, -0.5]}, "lam[1] is -0.5, below 0"),
    ("unique", {"lam": [0.25, 0.75]}, "lam[0] is off by 0.75"),
    ("off a row", {"lam": [0.25, 0.75]}, "lam[1] is 0.75 on a row whose slack is 0.001"),
    ("no room", {"farkas": ["1", "1", "1", "0"]}, ""),
    ("no room", {"farkas": ["1/3", "1", "1", "2/3"]}, "another Farkas vector"),
    ("no room", {"farkas": ["1/3", "1", "1", "333/500"]}, "A'y is not zero"),
    ("no room", {"farkas": [1.0, 1.0, 1.0, -1.0]}, "farkas has a negative entry"),
    ("no room", {"farkas": [1.0, 1.0, 0.9, 0.0]}, "A'y is not zero"),
    ("no room", {"farkas": [2.0, 2.0, 2.0, 0.0]}, "the largest entry must be 1, not 2.0"),
    ("no room", {"farkas": ["1", "2/3", "2/3", "-1/3"]}, "the Farkas vector has a negative entry"),
    ("no room", {"farkas": [*3 * ["1" + "0" * 400], "0"]}, "the largest entry must be 1, not inf"),
    ("no room", {"farkas": [*3 * ["9" * 5000], "0"]}, "the largest entry must be 1, not inf"),
    ("no room", {"farkas": [*3 * [1e308], 0.0]}, "the largest entry must be 1, not 1e+308"),
    ("no room", {"farkas": [1.0, 1.0, 1.0]}, "farkas must be a list of 4"),
    (
        "no room",
        {"farkas": ["1", "1", "1", "1/0"]},
        "the Farkas vector has entries that are no fractions",
    ),
    ("no room", {"farkas": [1.0, 1.0, 1.0, float("nan")]}, "farkas[3] must be a finite number"),
    ("no room", {"delta_q": [1.0, 1.0]}, "delta_q is no field of this output"),
    ("narrow", {"farkas": None, "delta_q": [0.5]}, "a contradiction smaller than rounding"),
    ("narrow", {"farkas": None, "delta_q": [0.5 + 1e-9]}, "farkas is missing"),
    ("equal", {"indices": [[2, 1]]}, "equal distances stand in the order of their places"),
    ("equal", {"indices": [[0, 2]]}, "indices[0][0] is off by 2"),  # not the nearest first
    ("equal", {"indices": [[2]]}, "indices[0] must have 2 entries, not 1"),
    ("filled", {"indices": [[3, 2, 5, 0, 6]]}, "right to 6 digits", 6),
    ("filled", {"indices": [[3, 2, 5, 0, 6]]}, "indices[0][0] is off by 1"),
    (
        "filled",
        {"indices": [[2, 1, 5, 0, 6]]},
        "indices[0][1] is 1: its normal is more than 0.25 rad from",
        6,
    ),
    (
        "filled",
        {"indices": [[2, 3, 5, 0, 7]]},
        "indices[0][4] is 7: indices must be whole numbers from 0 to 6",
        6,
    ),
    ("filled", {"indices": [[2, 3, 2, 0, 6]]}, "indices[0][2] is 2: it stands there twice", 6),
    ("squares", higher(0.3), "another witness of the same distance"),
    ("squares", higher(0.6), "alpha is outside its shape"),
    ("squares", {"alpha": [0.4, 0, 0], "beta": [1.4, 0, 0]}, "alpha is not where its shape ends"),
    ("squares", {"n": [0.0, 1.0, 0.0]}, "beta - alpha is not phi n"),
    ("squares", {"phi": 1.1}, "phi is off by 0.1"),
    ("one corner", higher(0.3), "another witness of the same distance"),
    ("one corner", higher(1e-13), "is off by 1e-13"),
]


@pytest.mark.parametrize("answer", ANSWERS)
def test_another_answer_is_judged_by_what_it_does(answer):
    planted, changes, says, *digits = answer
    verdict = judged(planted, changes, *digits)
    assert says in verdict.reason
    assert (verdict.verdict != "failed") == (not says or verdict.reason.startswith(RIGHT))


@pytest.mark.parametrize(
    ("layer", "field", "kind", "turn", "verdict"),
    [
        ("integrate", "q", "floating", slice(3, 7), "acceptable"),
        ("step", "q_next", "floating", slice(3, 7), "acceptable"),
        ("integrate", "q", "continuous", slice(0, 2), "failed"),
    ],
)
def test_minus_q_is_q_but_minus_cos_sin_is_not(layer, field, kind, turn, verdict):
    case = next(
        case
        for case in cases(layer)
        if {body["joint"] for body in case.input["mechanism"]["bodies"]} == {kind}
    )
    wanted = expected_of(layer)[case.id]
    q = list(wanted["output"][field])
    q[turn] = [-x for x in q[turn]]
    answer = wanted["output"] | {field: q}
    assert verdict_to_digits(layer, case.input, wanted, answer).verdict == verdict


SIGNS = {
    "all turned": lambda q, rng: -q,
    "w not below 0": lambda q, rng: q if q[3] >= 0 else -q,
    "by chance": lambda q, rng: q * rng.choice([-1.0, 1.0]),
}


@pytest.mark.parametrize("layer", ["integrate", "step"])
@pytest.mark.parametrize("sign", first(1, SIGNS))
def test_the_plain_program_is_right_with_any_sign_of_its_quaternions(layer, sign, rng):
    """Also where another freedom is used: other contacts, another lam."""
    field = {"integrate": "q", "step": "q_next"}[layer]
    outputs = {}
    for case in cases(layer):
        output = plain(PROGRAM[layer](case.input))
        if field in output:
            q = np.array(output[field])
            for place in quaternion_places(case.input["mechanism"]):
                q[place] = SIGNS[sign](q[place], rng)
            output[field] = q.tolist()
        outputs[case.id] = output
    report = report_on(layer, outputs)
    assert report.ok, report.trouble
