"""What of the vectors was passed, layer by layer, and nothing more."""

from dataclasses import dataclass

from quasistatic_ref.lab.vectors.check.report import LayerReport, Report
from quasistatic_ref.lab.vectors.versions import Edition


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
    def layers(self) -> tuple[LayerReport, ...]:
        """All layers, also those that are not answered."""
        return self.report.layers

    @property
    def answered(self) -> tuple[LayerReport, ...]:
        """Layers for which there is a file."""
        return tuple(one for one in self.layers if one.present)

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

        Within a declared scope it begins with what the scope holds, and a digit that was declared
        makes an answer no less whole.
        """
        if self.report.scope:
            return f"{self.report.scope.words or 'everything'}: {self._within}"
        if all(one.whole for one in self.layers):
            cases = sum(len(one.verdicts) for one in self.layers)
            return f"all {len(self.layers)} layers: {cases}/{cases}"
        layers = ", ".join(self._words(one) for one in self.answered)
        return f"{len(self.answered)} of {len(self.layers)} layers: {layers}"

    @property
    def complete(self) -> bool:
        """Whether everything that was answered, or within its scope everything, is right."""
        if self.report.scope:
            return all(one.complete for one in self.layers) and not self.report.few
        return all(one.whole for one in self.answered)

    @property
    def _within(self) -> str:
        """What was passed of a scope."""
        right = sum(one.right + one.loose for one in self.layers)
        cases = sum(len(one.verdicts) for one in self.layers)
        said = "all" if all(one.complete for one in self.layers) else "not all"
        few = f", few cases of {', '.join(self.report.few)}" if self.report.few else ""
        return f"{said} of {len(self.layers)} layers: {right}/{cases}{few}"

    def _words(self, one: LayerReport) -> str:
        """What of one layer was passed."""
        words = [f"{one.layer} {one.right + one.loose}/{len(one.verdicts)}"]
        if one.loose:
            words.append(f"to {self.report.digits:g} digits")
        if one.in_part:
            words.append(f"and {one.in_part} in part")
        if one.problem:
            words.append("(file not as it should be)")
        return " ".join(words)
