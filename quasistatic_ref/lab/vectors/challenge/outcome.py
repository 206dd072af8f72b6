"""What a challenge came to."""

from collections import Counter
from dataclasses import dataclass, field
from math import inf

from quasistatic_ref.lab.vectors.challenge.findings import Finding
from quasistatic_ref.lab.vectors.check.verdict import ACCEPTABLE, FAILED, PASSED
from quasistatic_ref.lab.vectors.layers import LAYERS


@dataclass
class Outcome:
    """What a challenge came to.

    Parameters
    ----------
    implementation : str
        As the program names itself.
    sent : Counter
        How many cases, by layer.
    verdicts : Counter
        Answers by (layer, verdict); ``unsupported``, ``error``, ``crash``, ... are verdicts too.
    findings : list of Finding
    remarks : list of str
        What is no mistake, but worth to know.
    found_after : float
        When the first answer that is wrong was seen [s]; infinite if none was.
    """

    implementation: str = ""
    sent: Counter[str] = field(default_factory=Counter)
    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    found_after: float = inf

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The table of verdicts by layer, its header first."""
        kinds = list(dict.fromkeys([PASSED, ACCEPTABLE, FAILED, *(k for _, k in self.verdicts)]))
        counts = [
            (layer, *(str(self.verdicts[layer, kind]) for kind in kinds))
            for layer in LAYERS
            if self.sent[layer]
        ]
        return [("layer", *kinds), *counts]

    @property
    def status(self) -> int:
        """Exit status: 1 if anything was found."""
        return int(bool(self.findings))
