"""Classic mistakes, recognised by what a program that makes them would have answered.

``mistakes.toml`` has their names and formulas, and ``table.py`` reads it.
Each known mistake is tried on the failing answers of a layer. It is named if it predicts at least
half of them to within a multiple of their tolerance where the right answer is another, and more of
them than right answers that it would have made wrong.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.vectors.check.compare import difference, leaves, parts, tolerance_of
from quasistatic_ref.lab.vectors.check.multipliers import program_rows
from quasistatic_ref.lab.vectors.check.report import Named
from quasistatic_ref.lab.vectors.check.table import MISTAKES, Mistake
from quasistatic_ref.lab.vectors.check.verdict import Verdict
from quasistatic_ref.lab.vectors.expected import Json

SAMPLE = 12
"""Failing cases that are tried, and right ones: mistakes are systematic, some predictions slow."""
SAME = 1e-9
"""Difference from a prediction, relative to the field's largest number, that still matches: a
mistake leaves the other digits right, but not to the last bit."""
ROUGH = 1e-5
"""The same of derivatives, which are predicted by differences in float64."""


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
    tried = _spread(failed)
    checked = _spread(right)
    found: list[tuple[int, int, Mistake]] = []
    for mistake in MISTAKES:
        if layer not in mistake.predictions:
            continue
        perfect = any(score == len(tried) for score, _, _ in found)
        explained = _hit_count(layer, mistake, tried, len(tried) if perfect else None)
        if not explained:
            continue
        spoiled = sum(_would_spoil(layer, mistake, one) for one in checked)
        if explained > spoiled:
            found.append((explained - spoiled, explained, mistake))
    best = max((score for score, _, _ in found), default=0)
    return tuple(
        Named(mistake.name, mistake.sentence, explained, len(tried))
        for score, explained, mistake in found
        if score == best
    )


def _hit_count(layer: str, mistake: Mistake, tried: Sequence[Failed], least: int | None) -> int:
    """How many of the failures it predicts; 0 if less than `least`, or than half."""
    wanted = -(-len(tried) // 2) if least is None else least
    explained = 0
    for i, one in enumerate(tried):
        explained += _is_predicted(layer, mistake, one)
        if explained + len(tried) - i - 1 < wanted:
            return 0
    return explained


def _spread(cases: Sequence[Failed]) -> Sequence[Failed]:
    """At most SAMPLE of the cases, from all families."""
    return cases[:: -(-len(cases) // SAMPLE)] if cases else cases


def _predictions(layer: str, mistake: Mistake, one: Failed) -> list[Json]:
    try:
        return list(mistake.predictions[layer](one.case, one.record["output"]))
    except (QuasistaticError, ValueError, KeyError, IndexError, TypeError, ArithmeticError):
        return []  # a mistake that cannot be made in this case


def _is_predicted(layer: str, mistake: Mistake, one: Failed) -> bool:
    """Whether one of the predictions is the answer wherever it is not the right answer.

    The field that fails first has to be one of those. Of a whole step no field after it is
    compared, since they follow from it.
    """
    if not isinstance(one.output, dict):
        return False
    answered = parts(one.output)
    for prediction in _predictions(layer, mistake, one):
        fields = {name: v for name, v in parts(prediction).items() if name in answered}
        wrong = [n for n, v in fields.items() if not _is_same(one, n, v, one.record["output"])]
        first = [i for i, name in enumerate(wrong) if _is_of(one.verdict.field, name)]
        if layer == "step" and first:
            wrong = wrong[: first[0] + 1]
        if first and all(_is_same(one, name, fields[name], one.output) for name in wrong):
            return True
    return False


def _is_of(field: str, name: str) -> bool:
    """Whether a failing field, which may be all contacts or unknown, is that of the name."""
    return field in ("", name, name.partition(".")[0])


def is_explained_by(layer: str, name: str, one: Failed) -> bool:
    """Whether a mistake of that name explains an answer."""
    known = next(mistake for mistake in MISTAKES if mistake.name == name)
    return _is_predicted(layer, known, one)


def _would_spoil(layer: str, mistake: Mistake, one: Failed) -> bool:
    """Whether every prediction is another than the answer, which is right."""
    predictions = _predictions(layer, mistake, one)
    return bool(predictions) and not any(
        all(_is_same(one, field, value, one.output) for field, value in parts(prediction).items())
        for prediction in predictions
    )


def _is_same(one: Failed, field: str, prediction: Json, output: Json) -> bool:
    try:
        ours = prediction
        theirs = parts(output)[field]
        if field == "lam" and not one.record["flags"].get("unique_multipliers", True):
            ours = _images(one, ours)
            theirs = _images(one, theirs)
        if [path for path, _ in leaves(ours)] != [path for path, _ in leaves(theirs)]:
            return False
        found = difference(field, ours, theirs, 0.0)
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError):
        return False  # an answer of another shape
    numbers = [abs(v) for _, v in leaves(ours) if isinstance(v, int | float)]
    size = max(numbers, default=0.0)
    share = ROUGH if field == "dq_dq" else SAME
    return found.error <= max(4 * tolerance_of(one.record["tolerance"], field), share * size)


def _images(one: Failed, lam: Json) -> Json:
    """A'lam in the place of a lam that is not unique."""
    A = program_rows(one.case, one.record["output"])
    if len(lam) != len(A):
        return lam
    return list(np.array(lam, dtype=np.float64) @ np.array(A).reshape(len(lam), -1))
