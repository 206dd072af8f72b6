"""What a challenge found in one case, and its folder."""

import json
import math
import shlex
from dataclasses import asdict, dataclass
from pathlib import Path

from quasistatic_ref.lab.vectors.check.side_by_side import side_by_side
from quasistatic_ref.lab.vectors.trees import Json, mapped
from quasistatic_ref.quoting import aligned
from quasistatic_ref.text.content import text_written

RECORD = "counterexample.json"
FORMAT = "quasistatic-ref/counterexample"


@dataclass(frozen=True)
class Failure:
    """A case that a program gets wrong.

    Parameters
    ----------
    id : str
        Of the case.
    layer : str
    kind : str
        ``wrong``, ``error``, ``end``, ``hang`` or ``garbage``.
    field : str
        What fails first; empty if nothing was compared.
    reason : str
        What was seen.
    case : dict
        The input.
    expected, given : object
        Outputs, side by side.
    """

    id: str
    layer: str
    kind: str
    field: str
    reason: str
    case: Json
    expected: Json = None
    given: Json = None

    @property
    def title(self) -> str:
        """A line with the case and the mistake."""
        return f"{self.id}: {self.kind}: {self.reason}"

    @property
    def record(self) -> dict[str, Json]:
        """The finding as a JSON object."""
        finite: dict[str, Json] = mapped(asdict(self), _finite)
        return {"format": FORMAT, "version": 2, **finite}

    def write_folder(self, folder: Path, command: str) -> Path:
        """Write the finding's folder: its record, and a page with the command that repeats it."""
        place = folder / self.id.replace("/", "-")
        text_written(place / RECORD, json.dumps(self.record, indent=1, allow_nan=False) + "\n")
        program = ("quasistatic-ref", "vectors", "challenge", "--command", command)
        again = shlex.join([*program, "--again", str(place / RECORD)])
        lines = [f"# {self.layer}: {self.field or self.kind}", ""]
        lines += [f"Seen: {self.reason}. Again:", "", f"    {again}", ""]
        lines += ["The input", "", f"    {json.dumps(self.case)}", ""]
        if self.expected is not None and self.given is not None:
            table = aligned(side_by_side(self.expected, self.given))
            lines += ["Expected, and given", "", *(f"    {row}" for row in table), ""]
        return text_written(place / "README.md", "\n".join(lines)).parent


def _finite(value: Json) -> Json:
    """A word in the place of a number that JSON has not: "nan", "inf"."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
