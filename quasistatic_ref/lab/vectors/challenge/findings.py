"""What a challenge found: each by its mistake and field, with the smallest case that shows it."""

import json
import math
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.formats.quoting import aligned
from quasistatic_ref.lab.vectors.check.side_by_side import side_by_side
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.trees import mapped

RECORD = "counterexample.json"
FORMAT = "quasistatic-ref/counterexample"


@dataclass(frozen=True)
class Finding:
    """Something that a program does wrong.

    Parameters
    ----------
    layer : str
    kind : str
        ``wrong``, ``error``, ``crash``, ``hang``, ``late``, ``garbage`` or ``stray``.
    field : str
        What fails first; empty if nothing was compared.
    mistakes : tuple of str
        Names of what explains it; none if nothing does.
    sentences : tuple of str
        What is right instead, for each.
    reason : str
        What was seen in the case.
    case : dict
        The smallest input that shows it.
    expected, given : object
        Outputs, side by side.
    first : str
        The id of the case in which it was found.
    cases : int
        In how many cases it was seen.
    """

    layer: str
    kind: str
    field: str
    mistakes: tuple[str, ...]
    sentences: tuple[str, ...]
    reason: str
    case: Json
    expected: Json
    given: Json
    first: str
    cases: int

    @property
    def name(self) -> str:
        """Of its folder: the mistake or the field, e.g. ``rows_A_sign-of-b``."""
        words = (self.layer, self.field or self.kind, *self.mistakes[:1])
        return "_".join(re.sub(r"[^A-Za-z0-9]+", "-", word).strip("-") for word in words)

    @property
    def title(self) -> str:
        """One line: the layer, the mistake, what was seen."""
        looks = f"looks like {' or '.join(self.mistakes)}: " if self.mistakes else ""
        times = f", {self.cases} case{'s' * (self.cases > 1)}" if self.kind == "wrong" else ""
        return f"{self.layer}: {looks}{self.reason} (first in {self.first}{times})"

    @property
    def record(self) -> dict[str, Json]:
        """As it stands in JSON."""
        return {
            "format": FORMAT,
            "version": 1,
            **{key: getattr(self, key) for key in self.__dataclass_fields__},
            "mistakes": list(self.mistakes),
            "sentences": list(self.sentences),
        }

    def write_folder(self, folder: Path, command: str) -> Path:
        """Write its folder: the record, and a page with the line that runs it again."""
        place = folder / self.name
        record = json.dumps(mapped(self.record, _finite), indent=1, allow_nan=False)
        text_written(place / RECORD, record + "\n")
        program = ("quasistatic-ref", "vectors", "challenge", "--command", command)
        again = shlex.join([*program, "--again", str(place / RECORD)])
        lines = [f"# {self.layer}: {', '.join(self.mistakes) or self.field or self.kind}", ""]
        lines += [*self.sentences, "", f"Seen: {self.reason}. Again:", "", f"    {again}", ""]
        lines += ["The input", "", f"    {json.dumps(self.case)}", ""]
        if self.expected is not None and self.given is not None:
            wanted = {key: value for key, value in self.expected.items() if key != "certificate"}
            table = aligned(side_by_side(wanted, self.given))
            lines += ["Expected, and given", "", *(f"    {row}" for row in table), ""]
        return text_written(place / "README.md", "\n".join(lines)).parent


def _finite(value: Json) -> Json:
    """A word in the place of a number that JSON has not: "nan", "inf"."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
