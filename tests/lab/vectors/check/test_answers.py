"""Answers that differ from what is expected: those that are right, and neighbours that are not."""

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.check.verdict import DIGITS, correct_digits
from quasistatic_ref.lab.vectors.converters import quaternion_places
from quasistatic_ref.lab.vectors.tables import ORIGIN, at
from tests.cases import first
from tests.closeness import assert_relative
from tests.lab.vectors.committed_cases import (
    cases,
    expected_of,
    inputs_of,
    plain_answer,
    report_on,
    verdict_of,
)

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
RIGHT = ("other ", "another ", "a contradiction ", "right to ", "-q ", "the right ", "no deri")
"""How reasons of acceptable answers begin."""


def higher(y):
    """The witness at another height of the facing squares."""
    return {"alpha": [0.5, y, 0.0], "beta": [1.5, y, 0.0]}


def change(field, of):
    """The change of a field to what a function makes of it."""
    return lambda output: {field: of(output[field])}


def first_b(value):
    """The change of the first entry of b."""
    return change("b", lambda b: [value, *b[1:]])


def without_a_beta(contacts):
    """Contacts of which the second has a field less."""
    one, second, *rest = contacts
    return [one, {name: v for name, v in second.items() if name != "beta"}, *rest]


def turned_more(forces):
    """Forces of which the sixth contact's torque is 1 mN m larger."""
    return [[*f[:3], f[3] + 1e-3 * (j == 5)] for j, f in enumerate(forces)]


def minus(field, begin, end):
    """The change of some entries of a field to their negatives."""
    return change(field, lambda q: [-x if begin <= i < end else x for i, x in enumerate(q)])


def reasons(*changes):
    """The reasons of a kink as often as there are changes, which are made in them."""
    return change("reasons", lambda reasons: [reasons[0] | each for each in changes])


def judged(name, changes, digits=None):
    """The verdict on an answer: what is expected, but for some fields, of which None is left out.

    A function makes the changes of the whole output; where it makes no fields, this is the answer.
    """
    if name in PLANTED:
        layer, case, output, flags = PLANTED[name]
        tolerance = {field: {"absolute": TOLERANCES.get(field, 0.0)} for field in output}
        record = {"output": output, "flags": flags, "tolerance": tolerance}
    else:
        layer = name.partition("/")[0]
        case, record = inputs_of(name), expected_of(layer)[name]
    output = record["output"]
    answer = changes(output) if callable(changes) else changes
    if isinstance(answer, dict):
        answer = {field: v for field, v in (output | answer).items() if v is not None}
    return verdict_of(layer, case, record, answer, digits)


ROWS, FLAT, STACK = "rows/random/3", "qp/ellipsoid/flat", "step/stack/0"
KINK, BALL = "derivative/kink/row/limit_x", "derivative/ball/pyramid"
NO_KINK = {"differentiable": False, "reasons": []}
ANSWERS = [
    # a case, changes of what is expected, words of the reason, to how many digits
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
    ("no room", {"farkas": ["1", "1", "1", "1/0"]}, "Farkas vector has entries that are no frac"),
    ("no room", {"farkas": [1.0, 1.0, 1.0, float("nan")]}, "farkas[3] must be a finite number"),
    ("no room", {"delta_q": [1.0, 1.0]}, "delta_q is no field of this output"),
    ("narrow", {"farkas": None, "delta_q": [0.5]}, "a contradiction smaller than rounding"),
    ("narrow", {"farkas": None, "delta_q": [0.5 + 1e-9]}, "farkas is missing"),
    ("narrow", {"farkas": None, "delta_q": [0.5 + 1e-9]}, "right to 6 digits", 6),
    ("narrow", {"farkas": None, "delta_q": [0.5 + 1e-3]}, "farkas is missing", 6),
    ("equal", {"indices": [[2, 1]]}, "equal distances stand in the order of their places"),
    ("equal", {"indices": [[0, 2]]}, "indices[0][0] is off by 2"),  # not the nearest first
    ("equal", {"indices": [[2]]}, "indices[0] must have 2 entries, not 1"),
    ("filled", {"indices": [[3, 2, 5, 0, 6]]}, "right to 6 digits", 6),
    ("filled", {"indices": [[3, 2, 5, 0, 6]]}, "indices[0][0] is off by 1"),
    ("filled", {"indices": [[2, 1, 5, 0, 6]]}, "[1] is 1: its normal is more than 0.25 rad", 6),
    ("filled", {"indices": [[2, 3, 5, 0, 7]]}, "is 7: indices must be whole numbers from 0 to", 6),
    ("filled", {"indices": [[2, 3, 2, 0, 6]]}, "indices[0][2] is 2: it stands there twice", 6),
    ("squares", higher(0.3), "another witness of the same distance"),
    ("squares", higher(0.6), "alpha is outside its shape"),
    ("squares", {"alpha": [0.4, 0, 0], "beta": [1.4, 0, 0]}, "alpha is not where its shape ends"),
    ("squares", {"n": [0.0, 1.0, 0.0]}, "beta - alpha is not phi n"),
    ("squares", {"phi": 1.1}, "phi is off by 0.1"),
    ("one corner", higher(0.3), "another witness of the same distance"),
    ("one corner", higher(1e-13), "is off by 1e-13"),
    (ROWS, {"b": None}, "b is missing"),
    (ROWS, change("b", lambda b: b[:-1]), "entries"),
    (ROWS, first_b(float("nan")), "finite"),
    (ROWS, first_b(None), "must be a number, not null, which many programs write for NaN"),
    (ROWS, first_b(True), "must be a number"),
    (ROWS, first_b(10**400), "finite"),
    (ROWS, change("A", lambda A: [v for row in A for v in row]), "A"),
    (ROWS, lambda output: None, "must be an object"),
    (FLAT, change("lam", lambda lam: [*lam[:-1], [[]]]), "must be a number"),
    (FLAT, change("A_lam", lambda A_lam: A_lam[:1]), "must have 6 entries"),
    (FLAT, change("lam", lambda lam: [1e308] * len(lam)), "lam is another one, and "),
    # Sums that overflow are inf or nan, by the order of summation.
    ("qp/grasp/0", change("lam", lambda lam: [1e308] * len(lam)), "A'lam is off by "),
    (STACK, change("forces", turned_more), "forces[5][3], tau_n of contact 5, is off by 0.001 "),
    (STACK, change("contacts", without_a_beta), "contacts[1].beta is missing"),
    *((STACK, {"contacts": none}, "contacts") for none in (5, "all", [5], {"phi": 0.0})),
    (
        "step/cloud/tilted", change("contacts", lambda c: sorted(c, key=lambda one: one["phi"])),
        "do not stand in the order of index",
    ),
    ("integrate/screw/tiny", minus("q", 3, 7), "-q in the place of a quaternion q"),
    ("step/ball/pyramid", minus("q_next", 3, 7), "-q in the place of a quaternion q"),
    ("integrate/continuous/continuous", minus("q", 0, 2), "q[1] is off by 1.7 "),
    (KINK, reasons({}, {"kind": "feature", "rows": []}), "the right reasons and further ones"),
    *(
        (KINK, reasons(other), "the reason is another one: row of floor, index [0]")
        for other in ({"kind": "feature"}, {"rows": [0]}, {"pair": "wall"}, {"index": [1]})
    ),
    (KINK, reasons(), "the reason is another one: row of floor, index [0]"),
    *((KINK, {"reasons": [none]}, "reasons must be a list of {kind, ") for none in ({}, "row")),
    (KINK, {"differentiable": True}, "q+ has no derivative here: row of floor"),
    ("derivative/stack/30", NO_KINK, "no derivative is given where a part of the step changes"),
    (BALL, NO_KINK, "q+ has derivatives here, and the answer says it has none"),
    (BALL, {"differentiable": "yes"}, "differentiable must be true or false"),
    (BALL, change("dq_dq", lambda dq_dq: dq_dq[:-1]), "dq_dq must have 6 entries, not 5"),
    (BALL, lambda output: None, "the output must be an object with the fields differentiable"),
]  # fmt: skip


@pytest.mark.parametrize("answer", ANSWERS)
def test_another_answer_is_judged_by_what_it_does(answer):
    name, changes, says, *digits = answer
    verdict = judged(name, changes, *digits)
    assert says in verdict.reason
    right = not says or verdict.reason.startswith(RIGHT)
    assert (verdict.verdict != "failed") == right
    assert (verdict.without, len(verdict.reason) < 400) == ((), True)


@pytest.mark.parametrize("name", dict.fromkeys(name for name, *_ in ANSWERS))
def test_the_expected_answer_passes(name):
    assert judged(name, {}).verdict == "passed"


@pytest.mark.parametrize("output", [{"q": 3.0}, {"q": ["a"] * 7}, {"q": {}}, {}], ids=str)
def test_a_bad_output_is_one_even_where_it_is_converted(output):
    report = report_on("integrate", {"integrate/screw/tiny": output}, quaternion="wxyz")
    assert report.count("failed") == 1


def test_an_error_that_underflows_relative_to_its_field_is_no_warning():
    # 5e-324 / 2 is 0 in float64, whose logarithm there is none of: all digits are right.
    assert correct_digits(5e-324, 2.0, 0.0) == DIGITS
    assert correct_digits(1.0, 1e-3, 0.0) == correct_digits(1.0, 0.0, 0.0) == 0.0
    assert_relative(correct_digits(1e-5, 1.0, 0.0), 5.0)


SIGNS = {
    "all turned": lambda q, rng: -q,
    "w not below 0": lambda q, rng: q if q[3] >= 0 else -q,
    "by chance": lambda q, rng: q * rng.choice([-1.0, 1.0]),
}


@pytest.mark.parametrize("layer", first(1, ["integrate", "step"]))
@pytest.mark.parametrize("sign", first(1, SIGNS))
def test_the_plain_program_is_right_with_any_sign_of_its_quaternions(layer, sign, rng):
    """Also where another freedom is used: other contacts, another lam."""
    outputs = {}
    field = {"integrate": "q", "step": "q_next"}[layer]
    for case in cases(layer):
        output = plain_answer(layer, case.input)
        if field in output:
            q = np.array(output[field])
            for place in quaternion_places(case.input["mechanism"]):
                q[place] = SIGNS[sign](q[place], rng)
            output[field] = q.tolist()
        outputs[case.id] = output
    report = report_on(layer, outputs)
    assert report.ok, report.trouble
