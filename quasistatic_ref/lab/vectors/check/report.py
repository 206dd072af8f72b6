"""The outcome of a check: by layer, as a table for people and as JSON for programs."""

from collections.abc import Sequence
from dataclasses import dataclass

from quasistatic_ref.lab.vectors.check.usual import usual_sentence
from quasistatic_ref.lab.vectors.check.verdict import (
    ACCEPTABLE,
    FAILED,
    MISSING,
    PASSED,
    UNSUPPORTED,
    Verdict,
)
from quasistatic_ref.lab.vectors.trees import Json

KINDS = (PASSED, ACCEPTABLE, FAILED, MISSING, UNSUPPORTED)
HEADER = ("layer", *KINDS, "worst digits", "first failure")


@dataclass(frozen=True)
class LayerReport:
    """The verdicts on all cases of one layer.

    Parameters
    ----------
    layer : str
    implementation : str
        As the answers name themselves.
    present : bool
        Whether there is a file of answers.
    problem : str
        What is wrong with the file itself; empty if nothing is.
    verdicts : tuple of Verdict
        Of every case, in the order of the inputs.
    must : bool
        Whether a layer without a file is a failure.
    """

    layer: str
    implementation: str
    present: bool
    problem: str
    verdicts: tuple[Verdict, ...]
    must: bool = False

    def count(self, verdict: str) -> int:
        """How many cases have a verdict."""
        return sum(v.verdict == verdict for v in self.verdicts)

    @property
    def words(self) -> str:
        """Why a layer is not right, e.g. ``not answered``, ``12 wrong, 3 missing``."""
        if not self.present:
            return "not answered"
        if self.problem:
            return "its file is not as it should be"
        wrong = ((self.count(FAILED), "wrong"), (self.count(MISSING), "missing"))
        return ", ".join(f"{count} {word}" for count, word in wrong if count)

    @property
    def passed(self) -> str:
        """E.g. ``rows 80 of 80``, with what is right in part or not supported."""
        good = [v for v in self.verdicts if v.verdict in (PASSED, ACCEPTABLE)]
        notes = (
            (sum(v.loose and not v.without for v in good), "to fewer digits"),
            (sum(bool(v.without) for v in good), "in part"),
            (self.count(UNSUPPORTED), "not supported"),
        )
        more = ", ".join(f"{count} {words}" for count, words in notes if count)
        count = f"{self.layer} {len(good)} of {len(self.verdicts)}"
        return f"{count} ({more})" if more else count

    @property
    def ok(self) -> bool:
        """Whether nothing failed, and nothing is missing from a layer that is answered."""
        if not self.present:
            return not self.must
        return not (self.problem or self.count(FAILED) or self.count(MISSING))

    @property
    def worst(self) -> Verdict | None:
        """The case with the fewest correct digits."""
        known = [v for v in self.verdicts if v.digits is not None]
        return min(known, key=lambda v: v.digits or 0.0, default=None)

    @property
    def first(self) -> Verdict | None:
        """The first case that fails, or else the first that is missing."""
        by_kind = (v for kind in (FAILED, MISSING) for v in self.verdicts if v.verdict == kind)
        return next(by_kind, None)

    @property
    def trouble(self) -> str:
        """A sentence on the first fault of the answers; empty if there is none."""
        if not self.present:
            return f"no {self.layer}.json"
        if self.problem:
            return self.problem
        return f"{self.first.id}: {self.first.reason}" if self.first else ""

    @property
    def partial(self) -> str:
        """A sentence on the outputs that the answers omit; empty if they omit none."""
        return self._named([v.without for v in self.verdicts], "are partial: nothing is said of")

    @property
    def unasked(self) -> str:
        """A sentence on fields that the layer does not ask for; empty if there are none."""
        words = "have fields that are not looked at:"
        return self._named([v.extra for v in self.verdicts], words)

    def _named(self, fields: Sequence[tuple[str, ...]], words: str) -> str:
        """How many answers have some of `fields`, and which; empty if none has."""
        names = ", ".join(dict.fromkeys(name for of_one in fields for name in of_one))
        count = f"{sum(map(bool, fields))} of {len(fields)} answers"
        return f"{self.layer}: {count} {words} {names}" if names else ""

    @property
    def row(self) -> tuple[str, ...]:
        """The layer's line in the printed table."""
        counts = (str(self.count(v)) for v in KINDS)
        digits = f"{self.worst.digits:.1f}" if self.worst else "-"
        first = self.first.id if self.present and self.first else "-"
        return (self.layer, *counts, digits, first)

    @property
    def record(self) -> dict[str, Json]:
        """The report on a layer as a JSON object."""
        return {
            "layer": self.layer,
            "implementation": self.implementation,
            "answered": self.present,
            "problem": self.problem or None,
            "ok": self.ok,
            **{verdict: self.count(verdict) for verdict in KINDS},
            "worst_digits": self.worst.digits if self.worst else None,
            "worst_case": self.worst.id if self.worst else None,
            "first_failure": self.first.record if self.present and self.first else None,
            "cases": [v.record for v in self.verdicts] if self.present else [],
        }


@dataclass(frozen=True)
class Report:
    """The outcome of a check: the reports on all layers of a folder of answers.

    Parameters
    ----------
    answers : str
        The folder.
    layers : tuple of LayerReport
    digits : float, optional
        [-] To how many digits an answer is acceptable.
    """

    answers: str
    layers: tuple[LayerReport, ...]
    digits: float | None = None

    @property
    def ok(self) -> bool:
        """Whether every layer that has answers is right."""
        return all(layer.ok for layer in self.layers)

    @property
    def status(self) -> int:
        """Exit status of the command: 0, or 1 if anything failed."""
        return 0 if self.ok else 1

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The table, its header first."""
        return [HEADER, *(layer.row for layer in self.layers)]

    @property
    def sentences(self) -> list[str]:
        """Sentences below the table: why a layer fails, where to look first, what is missing."""
        sentences = []
        for layer in self.layers:
            if layer.trouble and not layer.ok:
                sentences.append(f"{layer.layer}: {layer.trouble}")
            sentences += [words for words in (layer.partial, layer.unasked) if words]
        wrong = [layer for layer in self.layers if layer.count(FAILED)]
        if wrong:
            sentences.append(usual_sentence(wrong[0].layer))
        if self.digits is not None:
            sentences.append(f"answers that are right to {self.digits:g} digits are acceptable")
        unanswered = [layer.layer for layer in self.layers if not layer.present]
        if unanswered:
            sentences.append(f"not checked, because they have no answers: {', '.join(unanswered)}")
        return [*sentences, self.verdict]

    @property
    def verdict(self) -> str:
        """The last line of the report: what was passed, or which layers are not right.

        Examples
        --------
        ``right: rows 80 of 80, wrench 60 of 84 (24 not supported)``;
        ``not right: wrench (82 wrong)``.
        """
        if not self.ok:
            wrong = [f"{one.layer} ({one.words})" for one in self.layers if not one.ok]
            return f"not right: {', '.join(wrong)}"
        return f"right: {', '.join(one.passed for one in self.layers if one.present)}"

    @property
    def record(self) -> dict[str, Json]:
        """The report as a JSON object."""
        return {
            "format": "quasistatic-ref/vectors-report",
            "version": 2,
            "answers": self.answers,
            "ok": self.ok,
            "digits": self.digits,
            "verdict": self.verdict,
            "layers": [layer.record for layer in self.layers],
        }
