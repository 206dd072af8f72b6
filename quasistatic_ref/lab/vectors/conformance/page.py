"""The page of a conformance report, as data that is written as HTML and as Markdown."""

import statistics
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section, Table
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.report import LayerReport
from quasistatic_ref.lab.vectors.check.verdict import ACCEPTABLE
from quasistatic_ref.lab.vectors.conformance.conformance import Conformance

WHOLE = (
    "Passed is within the case's own tolerance, acceptable is right by a documented freedom or to "
    "the digits that were asked for; in part are those of both that leave fields out."
)
DIGITS = (0, 6, 9, 12, 15, 16)
"""Bounds of the columns that count answers by their correct digits [-]."""
COUNTED = (
    "How many answers have so many digits: -log10 of the largest error over the size of its field, "
    "of its worst field. Fields that may be others, such as multipliers that are not unique, are "
    "left out; answers of which no number is compared, such as Farkas vectors, have no digits."
)


def page(
    conformance: Conformance, answers: Mapping[str, Answers], versions: Sequence[Table]
) -> Report:
    """The report.

    Parameters
    ----------
    conformance : Conformance
    answers : mapping of str to Answers
        As each layer that is answered declares itself.
    versions : sequence of Table
        Versions and hashes.
    """
    layers = conformance.answered
    parts = (
        ("What was passed", _passed(conformance)),
        ("Correct digits", _digits(layers)),
        ("Freedoms used", _freedoms(layers, answers)),
        ("Mistakes", _mistakes(layers)),
        ("Of what nothing is said", _unsaid(conformance)),
        ("Versions and hashes", versions),
    )
    title = f"{conformance.implementation} and the {conformance.edition.name}"
    return Report(title, tuple(Section(heading, tuple(blocks)) for heading, blocks in parts))


def _passed(conformance: Conformance) -> Iterator[Block]:
    sentence = f"{conformance.label}: {conformance.message}."
    yield Picture("badge", "", {}, sentence, "", folder="", ending="svg", natural=True)
    rows = []
    for one in conformance.layers:
        counts = (*one.row[1:5], str(one.in_part)) if one.present else ("-",) * 5
        rows.append((one.layer, one.words, str(len(one.verdicts)), *counts))
    columns = ("layer", "verdict", "cases", "passed", "acceptable", "failed", "missing", "in part")
    yield Table("Layers", "", columns, tuple(rows), 2)
    yield WHOLE


def _digits(layers: Sequence[LayerReport]) -> Iterator[Block]:
    rows = []
    for layer in layers:
        known = [v.digits for v in layer.verdicts if v.digits is not None]
        if known and layer.worst is not None:
            worst = f"{min(known):.1f}", f"{statistics.median(known):.1f}"
            counts = map(str, np.histogram(known, DIGITS)[0])
            rows.append((layer.layer, layer.worst.id, str(len(known)), *worst, *counts))
    counted = (f"{low} to {high}" for low, high in pairwise(DIGITS))
    columns = ("layer", "its worst case", "compared", "fewest digits", "median", *counted)
    yield Table("Correct digits", "", columns, tuple(rows), 2)
    yield COUNTED


def _freedoms(layers: Sequence[LayerReport], answers: Mapping[str, Answers]) -> Iterator[Block]:
    found = Counter(
        (layer.layer, v.reason)
        for layer in layers
        for v in layer.verdicts
        if v.verdict == ACCEPTABLE
    )
    if not found:
        yield "Every answer that is right is the expected one."
    else:
        rows = tuple((*key, str(count)) for key, count in found.items())
        yield Table("Right, but not the expected answer", "", ("layer", "why", "cases"), rows, 2)
    for field, ours in (("tangent", "body"), ("quaternion", "xyzw")):
        others = {layer: getattr(a, field) for layer, a in answers.items()}
        for value in dict.fromkeys(v for v in others.values() if v != ours):
            names = ", ".join(layer for layer, v in others.items() if v == value)
            yield f"Declared, and converted before it was judged: `{field}` {value} in {names}."


def _mistakes(layers: Sequence[LayerReport]) -> Iterator[Block]:
    wrong = [layer for layer in layers if not layer.ok]
    if not wrong:
        yield "None was found."
        return
    rows = tuple((layer.layer, layer.trouble) for layer in wrong)
    yield Table("What fails first", "", ("layer", "what"), rows, 2)
    named = tuple(
        (layer.layer, m.name, m.sentence, f"{m.cases} of {m.of}")
        for layer in wrong
        for m in layer.mistakes
    )
    if named:
        columns = ("layer", "it looks like", "right is", "failures that it explains")
        yield Table("Mistakes that explain failures", "", columns, named, 3)
    else:
        yield "No classic mistake explains a failure."


def _unsaid(conformance: Conformance) -> Iterator[Block]:
    report = conformance.report
    silent = [layer.layer for layer in report.layers if not layer.present]
    if silent:
        yield f"Layers that are not answered: {', '.join(silent)}."
    said = [words for layer in report.layers for words in (layer.partial, layer.unasked) if words]
    yield from (f"{words}." for words in said)
    if report.digits is not None:
        yield (
            f"Answers that are right to {report.digits:g} digits were accepted: of a layer that "
            "passed by that, no more digits are claimed."
        )
    if conformance.changed:
        yield (
            f"The cases of {', '.join(conformance.changed)} are not those of any version that is "
            f"known by this name: what was passed is not {conformance.edition.name}."
        )
    yield (
        "Steps in sequence, cases that are in no vector (a challenge asks those), and speed are no "
        "part of the vectors."
    )
