"""The verdict on whether there are derivatives, and on the reason why there are none."""

from collections.abc import Sequence

from quasistatic_ref.lab.vectors.check.verdict import PASSED, Verdict, acceptance, failure
from quasistatic_ref.lab.vectors.layers.derivative import FIELDS
from quasistatic_ref.lab.vectors.trees import Json


def existence_verdict(record: Json, answer: Json) -> Verdict | None:
    """The verdict on whether derivatives exist; None if their numbers are to be compared.

    Parameters
    ----------
    record : dict
        What is expected: ``output``, ``flags``, ``tolerance``.
    answer : object
        The output of another program.
    """
    if not isinstance(answer, dict):
        names = ", ".join(("differentiable", "reasons", *FIELDS.values()))
        return failure("", f"the output must be an object with the fields {names}")
    if not isinstance(answer.get("differentiable"), bool):
        return failure("differentiable", "differentiable must be true or false")
    expected = record["output"]
    claimed = answer["differentiable"]
    if not expected["differentiable"]:
        return _kink(expected["reasons"], answer)
    if claimed:
        return None
    if record["flags"]["switch"]:
        return acceptance("no derivative is given where a part of the step changes its branch")
    return failure("differentiable", "q+ has derivatives here, and the answer says it has none")


def _kink(expected: Sequence[Json], answer: Json) -> Verdict:
    """The verdict at a kink, which compares the reasons and no numbers."""
    why = "; ".join(_words(reason) for reason in expected)
    if answer["differentiable"]:
        return failure("differentiable", f"q+ has no derivative here: {why}")
    if "reasons" not in answer:
        return Verdict("", PASSED, without=("reasons",))
    try:
        named = {_key(reason) for reason in answer["reasons"]}
    except (TypeError, KeyError):
        return failure("reasons", "reasons must be a list of {kind, pair, index, rows}")
    wanted = {_key(reason) for reason in expected}
    if named == wanted:
        return Verdict("", PASSED)
    if named > wanted:
        return acceptance("the right reasons and further ones")
    return failure("reasons", f"the reason is another one: {why}")


def _key(reason: Json) -> tuple[str, str, tuple[int, ...], tuple[int, ...]]:
    return reason["kind"], reason["pair"], tuple(reason["index"]), tuple(reason["rows"])


def _words(reason: Json) -> str:
    rows = f", rows {reason['rows']}" if reason["rows"] else ""
    return f"{reason['kind']} of {reason['pair']}, index {reason['index']}{rows}"
