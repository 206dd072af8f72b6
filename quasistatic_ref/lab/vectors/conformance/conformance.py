"""What of the vectors was passed, layer by layer, and nothing more."""

from dataclasses import dataclass

from quasistatic_ref.lab.vectors.check.report import LayerReport, Report
from quasistatic_ref.lab.vectors.check.verdict import ACCEPTABLE, FAILED, MISSING, PASSED, Verdict
from quasistatic_ref.lab.vectors.versions import Edition


@dataclass(frozen=True)
class Standing:
    """How the cases of one layer are divided; each is counted once.

    Parameters
    ----------
    layer : str
    cases : int
    right : int
        Whole answers, right as far as float64 can be, by a documented freedom or without.
    loose : int
        Whole answers that are right to the required digits alone.
    partial : int
        Answers that leave fields out, and are right in what they contain.
    failed, missing : int
    answered : bool
        Whether there is a file.
    problem : str
        What is wrong with the file itself.
    """

    layer: str
    cases: int
    right: int
    loose: int
    partial: int
    failed: int
    missing: int
    answered: bool
    problem: str

    @property
    def words(self) -> str:
        """E.g. ``right``, ``right to fewer digits``, ``12 wrong, 3 missing``, ``not answered``."""
        if not self.answered:
            return "not answered"
        if self.problem:
            return "its file is not as it should be"
        if self.failed or self.missing:
            counts = ((self.failed, "wrong"), (self.missing, "missing"))
            return ", ".join(f"{count} {word}" for count, word in counts if count)
        kinds = ((self.loose, "to fewer digits"), (self.partial, "in part"))
        return ", ".join(["right", *(word for count, word in kinds if count)])

    @property
    def complete(self) -> bool:
        """Whether every case is answered whole, and right to the digits that were asked for."""
        return self.answered and not self.problem and self.right + self.loose == self.cases

    @property
    def whole(self) -> bool:
        """Whether every case is answered whole and right."""
        return self.answered and not self.problem and self.right == self.cases


def standing(report: LayerReport) -> Standing:
    """How the cases of a layer are divided."""

    def count(kinds: tuple[str, ...], *, loose: bool = False, partial: bool = False) -> int:
        return sum(_is(v, kinds, loose, partial) for v in report.verdicts)

    good = (PASSED, ACCEPTABLE)
    return Standing(
        layer=report.layer,
        cases=len(report.verdicts),
        right=count(good),
        loose=count(good, loose=True),
        partial=count(good, partial=True) + count(good, loose=True, partial=True),
        failed=report.count(FAILED),
        missing=report.count(MISSING),
        answered=report.present,
        problem=report.problem,
    )


def _is(verdict: Verdict, kinds: tuple[str, ...], loose: bool, partial: bool) -> bool:
    return (verdict.verdict, verdict.loose, bool(verdict.without)) in {
        (kind, loose, partial) for kind in kinds
    }


@dataclass(frozen=True)
class Conformance:
    """What an implementation passed.

    Parameters
    ----------
    implementation : str
    report : Report
        Of all layers.
    edition : Edition
        Of the vectors.
    """

    implementation: str
    report: Report
    edition: Edition

    @property
    def layers(self) -> tuple[Standing, ...]:
        """All layers, also those that are not answered."""
        return tuple(map(standing, self.report.layers))

    @property
    def answered(self) -> tuple[Standing, ...]:
        """Layers for which there is a file."""
        return tuple(one for one in self.layers if one.answered)

    @property
    def changed(self) -> tuple[str, ...]:
        """Answered layers whose cases are not those of the version."""
        names = [one.layer for one in self.answered]
        return tuple(name for name in names if name in self.edition.changed)

    @property
    def label(self) -> str:
        """Against what: ``quasi-dynamic vectors 3``, and whether they were changed."""
        return f"{self.edition.name}{', changed' if self.changed else ''}"

    @property
    def message(self) -> str:
        """What was passed, e.g. ``2 of 8 layers: rows 62/62, qp 137/137 to 6 digits``.

        Within a declared scope it begins with the scope's name, and a digit that was declared
        makes an answer no less whole.
        """
        if self.report.scope:
            return f"{self.report.scope}: {self._within}"
        if all(one.whole for one in self.layers):
            cases = sum(one.cases for one in self.layers)
            return f"all {len(self.layers)} layers: {cases}/{cases}"
        layers = ", ".join(self._words(one) for one in self.answered)
        return f"{len(self.answered)} of {len(self.layers)} layers: {layers}"

    @property
    def complete(self) -> bool:
        """Whether everything that was answered, or within its scope everything, is right."""
        if self.report.scope:
            return all(one.complete for one in self.layers)
        return all(one.whole for one in self.answered)

    @property
    def _within(self) -> str:
        """What was passed of a scope."""
        digits = self.report.digits
        to = "" if digits is None else f" to {digits:g} digits"
        right = sum(one.right + one.loose for one in self.layers)
        cases = sum(one.cases for one in self.layers)
        said = "all" if self.complete else "not all"
        return f"{said} of {len(self.layers)} layers: {right}/{cases}{to}"

    def _words(self, one: Standing) -> str:
        """What of one layer was passed."""
        words = [f"{one.layer} {one.right + one.loose}/{one.cases}"]
        if one.loose:
            words.append(f"to {self.report.digits:g} digits")
        if one.partial:
            words.append(f"and {one.partial} in part")
        if one.problem:
            words.append("(file not as it should be)")
        return " ".join(words)
