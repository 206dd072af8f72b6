"""Outputs that are no right answer to their case."""

import pytest

from quasistatic_ref.lab.vectors.check.verdict import DIGITS, correct_digits
from tests.closeness import assert_relative
from tests.lab.vectors.committed_cases import cases, expected_of, report_on, right_answers


def changed(field, change):
    """The change of an output that replaces a field by what a function makes of it."""
    return lambda output: {**output, field: change(output[field])}


def first_b(value):
    """The change of an output that replaces the first entry of b."""
    return changed("b", lambda b: [value, *b[1:]])


def without_a_beta(contacts):
    """Contacts of which the second has a field less."""
    first, second, *rest = contacts
    return [first, {name: v for name, v in second.items() if name != "beta"}, *rest]


def turned_more(forces):
    """Forces of which the sixth contact's torque is 1 mN m larger."""
    return [[*f[:3], f[3] + 1e-3 * (j == 5)] for j, f in enumerate(forces)]


ROWS, FLAT, GRASP = "rows/random/3", "qp/ellipsoid/flat", "qp/grasp/0"
NO_CONTACTS = [5, "all of them", [5], {"phi": 0.0}]
BAD = {
    # name: (case, its output from the right one, words of the reason)
    "without a field": (ROWS, lambda output: {"A": output["A"]}, "b is missing"),
    "one row short": (ROWS, changed("b", lambda b: b[:-1]), "entries"),
    "NaN": (ROWS, first_b(float("nan")), "finite"),
    "null": (ROWS, first_b(None), "must be a number, not null, which many programs write for NaN"),
    "true": (ROWS, first_b(True), "must be a number"),
    "a huge integer": (ROWS, first_b(10**400), "finite"),
    "flattened": (ROWS, changed("A", lambda A: [v for row in A for v in row]), "A"),
    "nothing": (ROWS, lambda output: None, "must be an object"),
    "contacts of other fields": (
        "step/stack/0", changed("contacts", without_a_beta), "contacts[1].beta is missing",
    ),
    "lists in lam": (FLAT, changed("lam", lambda lam: [*lam[:-1], [[]]]), "must be a number"),
    "A_lam cut off": (FLAT, changed("A_lam", lambda A_lam: A_lam[:1]), "must have 6 entries"),
    "a lam beyond its cone": (
        FLAT, changed("lam", lambda lam: [1e308] * len(lam)), "lam is another one, and ",
    ),
    "a lam beyond float64": (  # sums that overflow are inf or nan, by the order of summation
        GRASP, changed("lam", lambda lam: [1e308] * len(lam)), "A'lam is off by ",
    ),
    "forces of another spin": (
        "step/stack/0", changed("forces", turned_more),
        "forces[5][3], tau_n of contact 5, is off by 0.001 ",
    ),
    "contacts in another order than that of index": (
        "step/cloud/tilted", changed("contacts", lambda c: sorted(c, key=lambda one: one["phi"])),
        "do not stand in the order of index",
    ),
    **{f"contacts = {no}": ("step/stack/0", changed("contacts", lambda _, no=no: no), "contacts")
       for no in NO_CONTACTS},
}  # fmt: skip


@pytest.mark.parametrize(("case", "spoilt", "says"), BAD.values(), ids=BAD)
def test_a_bad_output_fails_in_one_sentence(case, spoilt, says):
    layer = case.partition("/")[0]
    output = expected_of(layer)[case]["output"]
    assert report_on(layer, {case: output}).ok
    report = report_on(layer, {case: spoilt(output)})
    verdict = report.first
    assert verdict is not None
    assert report.partial == ""
    assert says in verdict.reason
    assert len(verdict.reason) < 400


@pytest.mark.parametrize("output", [{"q": 3.0}, {"q": ["a"] * 7}, {"q": {}}, {}], ids=str)
def test_a_bad_output_is_one_even_where_it_is_converted(output):
    name = next(
        case.id
        for case in cases("integrate")
        if case.input["mechanism"]["bodies"][0]["joint"] == "floating"
    )
    assert right_answers("integrate")[name]
    assert report_on("integrate", {name: output}, quaternion="wxyz").count("failed") == 1


def test_an_error_that_underflows_relative_to_its_field_is_no_warning():
    # 5e-324 / 2 is 0 in float64, whose logarithm there is none of: all digits are right.
    assert correct_digits(5e-324, 2.0, 0.0) == DIGITS
    assert correct_digits(1.0, 1e-3, 0.0) == correct_digits(1.0, 0.0, 0.0) == 0.0
    assert_relative(correct_digits(1e-5, 1.0, 0.0), 5.0)
