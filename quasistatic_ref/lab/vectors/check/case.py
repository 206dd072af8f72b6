"""The verdict on one answer."""

from dataclasses import replace

import numpy as np

from quasistatic_ref.lab.vectors.check.compare import (
    CONTACT,
    OPTIONAL,
    differences,
    field_names,
    shape_problem,
    without,
)
from quasistatic_ref.lab.vectors.check.derivative import existence_verdict
from quasistatic_ref.lab.vectors.check.freedoms import FREEDOMS, aligned, plain_failure
from quasistatic_ref.lab.vectors.check.loosened import loosened
from quasistatic_ref.lab.vectors.check.multipliers import farkas_verdict
from quasistatic_ref.lab.vectors.check.verdict import FAILED, PASSED, Verdict, acceptance, failure
from quasistatic_ref.lab.vectors.layers.derivative import FIELDS
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.quoting import one_line

IN_PART = ("step", "derivative")
"""Layers whose answers may leave fields out; nothing is said of these."""
CLAIMS = ("farkas", "delta_q", "lam")
"""Fields of which some cases of a quadratic program ask for one part, and some for the other."""
CONTRADICTION = 1e-14
"""Slack below zero, relative to the terms of its row, that float64 takes for none; to fewer digits
it is larger."""


def case_verdict(layer: str, case: Json, record: Json, answer: Json) -> Verdict:
    """The verdict on an answer in the package's own conventions.

    Parameters
    ----------
    layer : str
    case : dict
        The input.
    record : dict
        What is expected: ``output``, ``flags``, ``tolerance``.
    answer : object
        The output of another implementation.

    Returns
    -------
    Verdict
        Its id is empty. Fields that the layer does not ask for are named, and not looked at.
    """
    asked = {name: value for name, value in record["output"].items() if name != "certificate"}
    record = {**record, "output": asked}
    fields, extra = _asked_fields(layer, record, answer)
    return replace(_verdict(layer, case, record, fields), extra=extra)


def _asked_fields(layer: str, record: Json, answer: Json) -> tuple[Json, tuple[str, ...]]:
    """An answer without the fields that its layer never asks for, and their names."""
    if not isinstance(answer, dict):
        return answer, ()
    others = {"qp": CLAIMS, "step": CLAIMS, "derivative": ("reasons", *FIELDS.values())}
    known = (*record["output"], *others.get(layer, ()), *(f"contacts.{key}" for key in CONTACT))
    extra = [name for name in field_names(answer) if name not in known]
    return without(answer, extra), tuple(map(one_line, extra))


def _verdict(layer: str, case: Json, record: Json, answer: Json) -> Verdict:
    """The verdict on the fields that a layer asks for."""
    expected = record["output"]
    if layer == "derivative":
        if verdict := existence_verdict(record, answer):
            return verdict
        expected = {name: value for name, value in expected.items() if name in FIELDS.values()}
        answer = {name: value for name, value in answer.items() if name in expected}
    if layer in ("qp", "step") and isinstance(answer, dict):
        if "farkas" in answer and "farkas" in expected:
            return _verdict_on_proof(layer, case, record, answer)
        if "farkas" in answer:
            return failure("farkas", "farkas is given, but the case has a solution")
        if "farkas" in expected and (layer == "qp" or "delta_q" in answer):
            return _unseen(case, record, answer)
    missing = omissions(expected, answer) if layer in IN_PART and isinstance(answer, dict) else ()
    if missing:
        expected = without(expected, missing)
    return replace(_field_verdict(layer, case, record, expected, answer), without=missing)


def _field_verdict(layer: str, case: Json, record: Json, expected: Json, answer: Json) -> Verdict:
    """The verdict on the fields of an answer, number by number and by its layer's freedoms."""
    problem = shape_problem(layer, expected, answer)
    if problem:
        return failure(*problem, digits=0.0)
    signed = aligned(layer, case, expected, answer)
    compared = differences(expected, signed, record["tolerance"])
    failing = {name: d for name, d in compared.items() if not d.holds}
    if failing and layer not in FREEDOMS:
        return plain_failure(failing)
    digits = min((d.digits for d in compared.values() if d.holds), default=None)
    if failing:
        verdict = FREEDOMS[layer](case, record, signed, failing)
        return verdict if verdict.field else acceptance(verdict.reason, digits)
    if signed != answer:
        return acceptance("-q in the place of a quaternion q", digits)
    return Verdict("", PASSED, digits=digits)


def verdict_to_digits(
    layer: str, case: Json, record: Json, answer: Json, digits: float | None = None
) -> Verdict:
    """The verdict on an answer that needs to be right to a number of digits [-] only."""
    verdict = case_verdict(layer, case, record, answer)
    if digits is None or verdict.verdict != FAILED:
        return verdict
    loose = case_verdict(layer, case, loosened(record, digits), answer)
    if loose.verdict == FAILED:
        return loose
    right = acceptance(f"right to {digits:g} digits", loose.digits)
    return replace(right, without=loose.without, extra=loose.extra, loose=True)


def omissions(expected: Json, answer: Json) -> tuple[str, ...]:
    """Expected fields that are missing from an answer which has at least one."""
    present = field_names(answer)
    contacts = answer.get("contacts")
    of_contacts = isinstance(contacts, list) and any(isinstance(one, dict) for one in contacts)
    missing = [
        name
        for name in field_names(expected)
        if name not in (*present, *OPTIONAL["step"]) and (of_contacts or "." not in name)
    ]
    return tuple(missing) if set(expected) & set(answer) else ()


def _unseen(case: Json, record: Json, answer: Json) -> Verdict:
    """The verdict on a delta_q of rows whose contradiction is below their own rounding."""
    missing = failure("farkas", "the case has no solution; farkas is missing")
    rows = case if "A" in case else record["output"]
    try:
        A, b, x = (np.array(v, dtype=np.float64) for v in (rows["A"], rows["b"], answer["delta_q"]))
        slack = A @ x - b
        size = np.abs(A) @ np.abs(x) + np.abs(b)
    except (KeyError, TypeError, ValueError):
        return missing
    unseen = max(CONTRADICTION, record.get("rounding", 0.0))
    if not (slack >= -unseen * size).all():  # not: NaN
        return missing
    return acceptance("a contradiction smaller than rounding is not seen")


def _verdict_on_proof(layer: str, case: Json, record: Json, answer: Json) -> Verdict:
    """The verdict on a proof that a case has no solution, and on what led to it."""
    expected, led = (
        {name: value for name, value in fields.items() if name != "farkas"}
        for fields in (record["output"], answer)
    )
    verdict = _verdict(layer, case, {**record, "output": expected}, led)
    if verdict.verdict == FAILED:
        return verdict
    rows = case | expected | led  # its own, where it has them
    return farkas_verdict(rows, record, answer["farkas"])
