"""Classic mistakes, recognised by what a program that makes them would have answered.

Each hypothesis is tried on the failing answers of a layer. It is named if it predicts at least half
of them to within a multiple of their tolerance where the right answer is another, and more of them
than right answers that it would have made wrong.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.vectors.check.compare import difference, leaves, parts, tolerance_of
from quasistatic_ref.lab.vectors.check.hypotheses import HYPOTHESES
from quasistatic_ref.lab.vectors.check.hypothesis import Hypothesis
from quasistatic_ref.lab.vectors.check.multipliers import program_rows
from quasistatic_ref.lab.vectors.check.report import Named
from quasistatic_ref.lab.vectors.check.verdict import Verdict
from quasistatic_ref.lab.vectors.expected import Json

SAMPLE: Final = 12
"""Failing cases that are tried, and right ones: mistakes are systematic, some predictions slow."""
SAME: Final = 1e-9
"""Difference from a prediction, relative to the field's largest number, that still matches: a
mistake leaves the other digits right, but not to the last bit."""


@dataclass(frozen=True)
class Failed:
    """One case with its answer, as far as it is needed to find the mistake.

    Parameters
    ----------
    id : str
    case : dict
        The input.
    record : dict
        What is expected.
    output : object
        The answer, in the package's conventions.
    verdict : Verdict
    """

    id: str
    case: Json
    record: Json
    output: Json
    verdict: Verdict


def mistakes_of(layer: str, failed: Sequence[Failed], right: Sequence[Failed]) -> tuple[Named, ...]:
    """What explains the failures of a layer, the best explanation first; often nothing."""
    if not failed:
        return ()
    tried, checked = _spread(failed), _spread(right)
    found: list[tuple[int, int, Hypothesis]] = []
    for hypothesis in HYPOTHESES:
        if layer not in hypothesis.predictions:
            continue
        perfect = any(score == len(tried) for score, _, _ in found)
        explained = _explained(layer, hypothesis, tried, len(tried) if perfect else None)
        if not explained:
            continue
        spoiled = sum(_would_spoil(layer, hypothesis, one) for one in checked)
        if explained > spoiled:
            found.append((explained - spoiled, explained, hypothesis))
    best = max((score for score, _, _ in found), default=0)
    return tuple(
        Named(hypothesis.name, hypothesis.sentence, explained, len(tried))
        for score, explained, hypothesis in found
        if score == best
    )


def _explained(
    layer: str, hypothesis: Hypothesis, tried: Sequence[Failed], least: int | None
) -> int:
    """How many of the failures a hypothesis predicts; 0 if less than `least`, or than half."""
    wanted = -(-len(tried) // 2) if least is None else least
    explained = 0
    for i, one in enumerate(tried):
        explained += _predicted(layer, hypothesis, one)
        if explained + len(tried) - i - 1 < wanted:
            return 0
    return explained


def _spread(cases: Sequence[Failed]) -> Sequence[Failed]:
    """At most SAMPLE of the cases, from all families."""
    return cases[:: -(-len(cases) // SAMPLE)] if cases else cases


def _predictions(layer: str, hypothesis: Hypothesis, one: Failed) -> list[Json]:
    first = hypothesis.first if layer == "step" else ()
    if first and one.verdict.field and one.verdict.field not in first:
        return []
    try:
        return list(hypothesis.predictions[layer](one.case, one.record["output"]))
    except (QuasistaticError, ValueError, KeyError, IndexError, TypeError, ArithmeticError):
        return []  # a mistake that cannot be made in this case


def _predicted(layer: str, hypothesis: Hypothesis, one: Failed) -> bool:
    """Whether one of the predictions is the answer wherever it is not the right answer."""
    if not isinstance(one.output, dict):
        return False
    expected = one.record["output"]
    for prediction in _predictions(layer, hypothesis, one):
        fields = _comparable(layer, one, prediction)
        wrong = {name: v for name, v in fields.items() if not _same(one, name, v, expected)}
        if wrong and all(_same(one, name, value, one.output) for name, value in wrong.items()):
            return True
    return False


def predicted(layer: str, name: str, one: Failed) -> bool:
    """Whether a mistake of that name explains an answer."""
    known = next(hypothesis for hypothesis in HYPOTHESES if hypothesis.name == name)
    return _predicted(layer, known, one)


def _would_spoil(layer: str, hypothesis: Hypothesis, one: Failed) -> bool:
    """Whether every prediction is another than the answer, which is right."""
    predictions = _predictions(layer, hypothesis, one)
    return bool(predictions) and not any(
        all(_same(one, field, value, one.output) for field, value in parts(prediction).items())
        for prediction in predictions
    )


def _comparable(layer: str, one: Failed, prediction: Json) -> dict[str, Json]:
    """The fields to compare: of a whole step the first that fails, the others follow from it."""
    fields = parts(prediction)
    if layer != "step":
        return fields
    first = one.verdict.field
    if first in fields:
        return {first: fields[first]}
    inside = {name: v for name, v in fields.items() if name.partition(".")[0] == first}
    return dict(list(inside.items())[:1])


def _same(one: Failed, field: str, prediction: Json, output: Json) -> bool:
    try:
        ours, theirs = prediction, parts(output)[field]
        if field == "lam" and not one.record["flags"].get("unique_multipliers", True):
            ours, theirs = _images(one, ours), _images(one, theirs)
        if [path for path, _ in leaves(ours)] != [path for path, _ in leaves(theirs)]:
            return False
        found = difference(field, ours, theirs, 0.0)
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError):
        return False  # an answer of another shape
    numbers = [abs(v) for _, v in leaves(ours) if isinstance(v, int | float)]
    size = max(numbers, default=0.0)
    return found.error <= max(4 * tolerance_of(one.record["tolerance"], field), SAME * size)


def _images(one: Failed, lam: Json) -> Json:
    """A'lam in the place of a lam that is not unique."""
    A = program_rows(one.case, one.record["output"])
    if len(lam) != len(A):
        return lam
    return list(np.array(lam, dtype=np.float64) @ np.array(A).reshape(len(lam), -1))
