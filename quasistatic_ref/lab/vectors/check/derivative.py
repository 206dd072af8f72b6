"""The verdict on derivatives: whether there are any first, then their numbers."""

from collections.abc import Sequence
from typing import Final

from quasistatic_ref.lab.vectors.check.compare import differences, shape_problem
from quasistatic_ref.lab.vectors.check.verdict import PASSED, Verdict, acceptable, failure
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.derivative import FIELDS

SAID: Final = ("differentiable", "reasons")


def derivative_verdict(record: Json, answer: Json) -> Verdict:
    """What becomes of an answer of the layer `derivative`.

    Parameters
    ----------
    record : dict
        What is expected: ``output``, ``flags``, ``tolerance``.
    answer : object
        The output of another program.
    """
    if not isinstance(answer, dict):
        names = ", ".join((*SAID, *FIELDS.values()))
        return failure("", f"the output must be an object with the fields {names}")
    if not isinstance(answer.get("differentiable"), bool):
        return failure("differentiable", "differentiable must be true or false")
    expected, claimed = record["output"], answer["differentiable"]
    if not expected["differentiable"]:
        return _kink(expected["reasons"], answer)
    if claimed:
        return _numbers(record, answer)
    if record["flags"]["switch"]:
        return acceptable("no derivative is given where a part of the step changes its branch")
    return failure("differentiable", "q+ has derivatives here, and the answer says it has none")


def _kink(expected: Sequence[Json], answer: Json) -> Verdict:
    """At a kink numbers are not looked at, but reasons are."""
    why = "; ".join(_words(reason) for reason in expected)
    if answer["differentiable"]:
        return failure("differentiable", f"q+ has no derivative here: {why}")
    if "reasons" not in answer:
        return Verdict("", PASSED, without=("reasons",))
    try:
        given = {_key(reason) for reason in answer["reasons"]}
    except (TypeError, KeyError):
        return failure("reasons", "reasons must be a list of {kind, pair, index, rows}")
    wanted = {_key(reason) for reason in expected}
    if given == wanted:
        return Verdict("", PASSED)
    if given > wanted:
        return acceptable("the right reasons and further ones")
    return failure("reasons", f"the reason is another one: {why}")


def _key(reason: Json) -> tuple[str, str, tuple[int, ...], tuple[int, ...]]:
    return reason["kind"], reason["pair"], tuple(reason["index"]), tuple(reason["rows"])


def _words(reason: Json) -> str:
    rows = f", rows {reason['rows']}" if reason["rows"] else ""
    return f"{reason['kind']} of {reason['pair']}, index {reason['index']}{rows}"


def _numbers(record: Json, answer: Json) -> Verdict:
    expected = {k: v for k, v in record["output"].items() if k not in SAID}
    given = {k: v for k, v in answer.items() if k not in SAID}
    for name in given:
        if name not in FIELDS.values():
            known = ", ".join((*SAID, *FIELDS.values()))
            return failure(name, f"{name} is no field of this output; its fields are {known}")
    wanted = {name: value for name, value in expected.items() if name in given}
    if not wanted:
        return failure("dq_dq", "no derivative is answered")
    judged = {name: given[name] for name in wanted}
    if problem := shape_problem("derivative", wanted, judged):
        return failure(*problem, digits=0.0)
    found = differences(wanted, judged, record["tolerance"])
    failing = [d for d in found.values() if not d.holds]
    if failing:
        return failure(failing[0].field, failing[0].sentence, failing[0].digits)
    without = tuple(name for name in expected if name not in given)
    digits = min((d.digits for d in found.values()), default=None)
    return Verdict("", PASSED, digits=digits, without=without)
