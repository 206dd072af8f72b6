"""``vectors check``: a folder of answers against the reference vectors, layer by layer."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.check.answers import Answers, answers_read
from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.check.report import LayerReport, Report
from quasistatic_ref.lab.vectors.check.verdict import (
    DIGITS,
    MISSING,
    UNSUPPORTED,
    Verdict,
    failure,
)
from quasistatic_ref.lab.vectors.converters import converted
from quasistatic_ref.lab.vectors.files import Case, check_layer, expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.trees import Json


def check_answers(
    answers: str | Path,
    vectors: str | Path,
    layers: Sequence[str] | None = None,
    *,
    only: Sequence[str] = (),
    digits: float | None = None,
) -> Report:
    """Compare a folder of answers with the vectors.

    Parameters
    ----------
    answers : path
        Folder with a ``LAYER.json`` for each layer that is answered.
    vectors : path
        Folder of the reference vectors.
    layers : sequence of str, optional
        Layers that have to be answered. By default all are looked at, and one without a file is
        reported but no failure.
    only : sequence of str
        Beginnings of the ids of the cases that are looked at, e.g. ``rows/cone``; by default all.
    digits : float, optional
        [-] An answer that is right to so many digits is acceptable.

    Returns
    -------
    Report

    Raises
    ------
    InputError
        If the *vectors* cannot be read, the folder of answers does not exist or answers no layer,
        or a layer has an unknown name. A bad file of answers is reported, never raised.
    """
    if digits is not None and not 0 < digits <= DIGITS:
        raise InputError(f"must be from 0 to {DIGITS:g}", field="digits", value=digits)
    folder = Path(answers)
    if not folder.is_dir():
        raise InputError("is not a folder of answers; name one with LAYER.json", file=folder)
    if only and layers is None:
        layers = list(dict.fromkeys(one.partition("/")[0] for one in only))
    named = LAYERS if layers is None else [check_layer(name) for name in layers]
    known = [name for name in named if (Path(vectors) / "expected" / f"{name}.json").exists()]
    if not known:
        raise InputError("holds no expected/LAYER.json; name a folder of vectors", file=vectors)
    of_layers = {name: answers_read(folder, name) for name in known}
    if not any(answer.present for answer in of_layers.values()):
        names = ", ".join(f"{name}.json" for name in known)
        raise InputError(f"answers no layer; the files looked for are {names}", file=folder)
    reports = []
    for name in known:
        records = expected_read(vectors, name)
        cases = _cases_named(inputs_read(vectors, name), only, name)
        if cases:
            report = layer_report(name, cases, records, of_layers[name], digits)
            reports.append(replace(report, must=layers is not None))
    return Report(str(folder), tuple(reports), digits)


def _cases_named(cases: Sequence[Case], only: Sequence[str], layer: str) -> Sequence[Case]:
    """The cases of a layer whose ids are named, or begin as is named; all where none is."""
    chosen: list[Case] = []
    for one in only:
        matching = [case for case in cases if case.id.startswith(one)]
        matching = [case for case in matching if case.id == one] or matching
        if not matching and one.partition("/")[0] == layer:
            raise InputError(
                "is no beginning of the id of a case; see inputs/LAYER.json",
                field="only",
                value=one,
            )
        chosen += [case for case in matching if case not in chosen]
    return chosen if only else cases


@np.errstate(all="ignore")  # answers may be any numbers: what overflows does not match
def layer_report(
    layer: str,
    cases: Sequence[Case],
    expected: dict[str, Json],
    answers: Answers,
    digits: float | None = None,
) -> LayerReport:
    """The verdicts on all answers of one layer.

    Parameters
    ----------
    layer : str
    cases : sequence of Case
    expected : dict
        Records of ``expected/LAYER.json`` by id.
    answers : Answers
    digits : float, optional
        [-] An answer that is right to so many digits is acceptable.
    """
    verdicts: list[Verdict] = []
    for case in cases:
        record = expected[case.id]
        if case.id in answers.unsupported:
            verdicts.append(Verdict(case.id, UNSUPPORTED))
            continue
        if case.id not in answers.outputs:
            verdicts.append(Verdict(case.id, MISSING, "no answer"))
            continue
        answer = answers.outputs[case.id]
        verdict, _ = answer_judged(layer, case, record, answer, answers, digits)
        verdicts.append(verdict)
    answered = [*answers.outputs, *answers.unsupported]
    unknown = [name for name in answered if name not in expected]
    problem = answers.problem
    if unknown and not problem:
        problem = f"{layer}.json answers {unknown[0]!r}, which is no case of the layer"
    return LayerReport(
        layer=layer,
        implementation=answers.implementation,
        present=answers.present,
        problem=problem,
        verdicts=tuple(verdicts),
    )


def answer_judged(
    layer: str,
    case: Case,
    record: Json,
    answer: Json,
    answers: Answers,
    digits: float | None = None,
) -> tuple[Verdict, Json]:
    """The verdict on one answer, and the answer in the package's conventions.

    Parameters
    ----------
    layer : str
    case : Case
    record : dict
        What is expected.
    answer : object
        The output of another implementation, in the conventions that are declared in `answers`.
    answers : Answers
    digits : float, optional
        [-].
    """
    try:
        output = converted(layer, case.input, answer, answers.tangent, answers.quaternion)
        verdict = verdict_to_digits(layer, case.input, record, output, digits)
        verdict = verdict.named(case.id)
    except InputError:
        raise
    except (ValueError, TypeError, KeyError, IndexError, ArithmeticError) as error:
        # Of a shape that only a conversion meets before its shape is checked.
        output = answer
        verdict = failure("", f"the output is no output of this layer: {error}").named(case.id)
    return verdict, output
