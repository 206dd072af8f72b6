"""What of the vectors was passed, layer by layer, and nothing more."""

import hashlib
import platform
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.report import LayerReport, Report
from quasistatic_ref.lab.vectors.check.scope import WHOLE, Scope
from quasistatic_ref.lab.vectors.check.verdict import ACCEPTABLE
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.versions import Edition, edition

FORMAT = "quasistatic-ref/vectors-conformance"
LONGEST = 80
"""Characters of the name of an implementation."""


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
    def answered_layers(self) -> tuple[LayerReport, ...]:
        """Layers for which there is a file."""
        return tuple(one for one in self.layers if one.present)

    @property
    def changed_layers(self) -> tuple[str, ...]:
        """Answered layers whose cases are not those of the version."""
        names = [one.layer for one in self.answered_layers]
        return tuple(name for name in names if name in self.edition.changed)

    @property
    def label(self) -> str:
        """Against what: ``quasi-dynamic vectors 3``, and whether they were changed."""
        return f"{self.edition.name}{', changed' if self.changed_layers else ''}"

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
        layers = ", ".join(self._words(one) for one in self.answered_layers)
        return f"{len(self.answered_layers)} of {len(self.layers)} layers: {layers}"

    @property
    def complete(self) -> bool:
        """Whether everything that was answered, or within its scope everything, is right."""
        if self.report.scope:
            return all(one.complete for one in self.layers) and not self.report.few
        return all(one.whole for one in self.answered_layers)

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

    @property
    def sentences(self) -> list[str]:
        """What was passed, what was not, and of what nothing is said."""
        said = [f"{self.label}: {self.message}", *self.report.sentences]
        for one in self.answered_layers:
            freedoms = Counter(v.reason for v in one.verdicts if v.verdict == ACCEPTABLE)
            said += [f"{one.layer}: right, {count} times {why}" for why, count in freedoms.items()]
        if self.changed_layers:
            said.append(
                f"the cases of {', '.join(self.changed_layers)} are not those of any known version "
                f"of this name: what was passed is not {self.edition.name}"
            )
        said.append("steps in sequence, new cases (a challenge asks those) and speed are no part")
        return said

    @property
    def record(self) -> dict[str, Json]:
        """The same for programs, with versions and hashes; without single cases."""
        layers = []
        for one in self.layers:
            file = Path(self.report.answers, f"{one.layer}.json")
            code = hashlib.sha256(bytes_read(file)).hexdigest() if one.present else None
            layers.append({
                **{key: value for key, value in one.record.items() if key != "cases"},
                "in_part": one.in_part, "to_fewer_digits": one.loose, "answers_sha256": code,
                "frozen": one.layer not in self.edition.changed,
                "vectors_sha256": self.edition.hashes[one.layer],
            })  # fmt: skip
        return {
            "format": FORMAT,
            "version": 2,
            "implementation": self.implementation,
            "vectors": self.edition.release,
            "judge": f"quasistatic_ref {__version__}",
            "python": platform.python_version(),
            "numpy": np.__version__,
            "digits": self.report.digits,
            "scope": self.report.record["scope"],
            "ok": self.report.ok,
            "label": self.label,
            "message": self.message,
            "layers": layers,
        }


def conformance(
    answers: Path,
    vectors: Path,
    implementation: str | None = None,
    digits: float | None = None,
    scope: Scope = WHOLE,
) -> Conformance:
    """What a folder of answers passed, of all layers.

    Parameters
    ----------
    answers, vectors : Path
        Folders.
    implementation : str, optional
        Its name; by default as the answers name themselves.
    digits : float, optional
        [-] An answer that is right to so many digits is acceptable.
    scope : Scope
        What it says that it does.

    Raises
    ------
    InputError
        As `check_answers` does, and of a name that is none.
    """
    report = check_answers(answers, vectors, digits=digits, scope=scope)
    names = dict.fromkeys(layer.implementation for layer in report.layers if layer.implementation)
    name = implementation if implementation is not None else " and ".join(names)
    name = name.strip()
    if not name or len(name) > LONGEST or not name.isprintable():
        problem = f"must be a name of 1 to {LONGEST} characters on one line"
        raise InputError(problem, field="--implementation", value=name)
    return Conformance(name, report, edition(vectors))
