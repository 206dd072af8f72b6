"""``vectors challenge``: new cases, from easy to hard, asked of a program and compared.

Every case follows from the seed, its layer and its number.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from itertools import count

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.challenge.finding import Failure
from quasistatic_ref.lab.vectors.challenge.fresh import CHALLENGED, fresh_case, record_of
from quasistatic_ref.lab.vectors.challenge.program import Function, Program, Simulator
from quasistatic_ref.lab.vectors.challenge.random_scenes import EASY, HARD, PLAIN
from quasistatic_ref.lab.vectors.check.folder import answer_judged
from quasistatic_ref.lab.vectors.check.usual import usual_sentence
from quasistatic_ref.lab.vectors.check.verdict import FAILED, PASSED
from quasistatic_ref.lab.vectors.files import Case, check_layer
from quasistatic_ref.lab.vectors.trees import Json

EASY_CASES = 5
"""The first cases of a layer; plain ones and hard ones take turns after them."""
MOST_FINDINGS = 3
"""Findings of a layer, after which it gets no further cases."""
ROUND = ("cylinder", "cone", "ellipsoid")
EDGED = ("box", "capsule", "convex")
"""Kinds of shapes: the plain program has no answer where a round one overlaps one of these, or
another round one."""
UNANSWERED = (
    f"not asked: a {', '.join(ROUND[:-1])} or {ROUND[-1]} in a {', '.join(EDGED[:-1])} or "
    f"{EDGED[-1]} shape, or in another of them: the plain program has no answer where they overlap"
)
CASES = 1000
"""How many are asked if neither they nor the time is limited."""


@dataclass
class Outcome:
    """The outcome of a challenge: its counts, and the mistakes that it met.

    Parameters
    ----------
    implementation : str
        As the program names itself.
    verdicts : Counter
        Answers by (layer, verdict); ``unsupported``, ``error``, ``end``, ... are verdicts, too.
    findings : list of Failure
    """

    implementation: str = ""
    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    findings: list[Failure] = field(default_factory=list)

    def cases(self, layer: str) -> int:
        """How many cases of a layer were asked."""
        return sum(number for (name, _), number in self.verdicts.items() if name == layer)

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The table of verdicts by layer, its header first."""
        kinds = list(dict.fromkeys([PASSED, FAILED, *(kind for _, kind in self.verdicts)]))
        counts = [
            (layer, *(str(self.verdicts[layer, kind]) for kind in kinds))
            for layer in CHALLENGED
            if self.cases(layer)
        ]
        return [("layer", *kinds), *counts]

    @property
    def remark(self) -> str:
        """Where to look first; empty if no answer is wrong."""
        wrong = {finding.layer for finding in self.findings if finding.kind == "wrong"}
        return next((usual_sentence(layer) for layer in CHALLENGED if layer in wrong), "")

    @property
    def not_asked(self) -> str:
        """What no case of its layers has; empty if they have no pairs of shapes."""
        return UNANSWERED if self.cases("distance") or self.cases("step") else ""

    @property
    def status(self) -> int:
        """Exit status: 1 if anything was found."""
        return int(bool(self.findings))


def challenge(
    program: Program | Simulator,
    *,
    layers: Sequence[str] | None = None,
    cases: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    digits: float | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> Outcome:
    """Ask a program new cases, and report its mistakes.

    Parameters
    ----------
    program : Program or callable
        Or a function (layer, input) -> output; None is the answer to what it does not support.
    layers : sequence of str, optional
        By default all but ``derivative``, which has no new cases.
    cases : int, optional
        How many at most; 1,000 if neither they nor the time is limited.
    seconds : float, optional
        Nothing is asked after that time; an answer that is awaited then is waited for [s].
    seed : int
    digits : float, optional
        [-] An answer that is right to so many digits is accepted.
    report : callable
        Called with a line about each finding.

    Returns
    -------
    Outcome

    Raises
    ------
    InputError
        Of an unknown layer, of one without new cases, and of a program that does not start.
    """
    names = [_check_asked(name) for name in layers or CHALLENGED]
    until = math.inf if seconds is None else time.monotonic() + seconds
    limit = cases or (CASES if seconds is None else math.inf)
    outcome = Outcome()
    with closing(program if isinstance(program, Program) else Function(program)) as player:
        for number in count():
            level = EASY if number < EASY_CASES else (PLAIN, HARD)[number % 2]
            names = [name for name in names if _goes_on(outcome, player, name)]
            for name in names:
                if outcome.verdicts.total() >= limit or time.monotonic() >= until:
                    return outcome
                id = f"{name}/{('easy', 'plain', 'hard')[level]}/{seed}-{number}"
                case, record = fresh_case(name, (seed, number), level)
                finding = _asked(player, outcome, id, name, case, record, digits)
                if finding:
                    report(finding.title)
            if not names:
                break
    return outcome


def asked_again(program: Program, finding: Json, digits: float | None = None) -> Outcome:
    """Ask the case of a counterexample once more.

    Parameters
    ----------
    program : Program
    finding : dict
        The record of a counterexample.
    digits : float, optional
        [-].

    Raises
    ------
    InputError
        If its case has no answer, or several.
    """
    layer = _check_asked(finding.get("layer", ""))
    case = finding.get("case")
    record = record_of(layer, case)
    if record is None:
        raise InputError(f"must be an input of {layer} with exactly one answer", field="case")
    outcome = Outcome()
    with program:
        _asked(program, outcome, str(finding.get("id")), layer, case, record, digits)
    return outcome


def _check_asked(name: str) -> str:
    if check_layer(name) not in CHALLENGED:
        raise InputError("has no new cases; the vectors have some", field="layer", value=name)
    return name


def _goes_on(outcome: Outcome, player: Program | Function, layer: str) -> bool:
    """Whether a layer gets further cases."""
    seen = sum(finding.layer == layer for finding in outcome.findings)
    cases = outcome.cases(layer)
    refused = cases >= EASY_CASES and outcome.verdicts[layer, "unsupported"] == cases
    return layer in player.layers and seen < MOST_FINDINGS and not refused


def _asked(
    player: Program | Function,
    outcome: Outcome,
    id: str,
    layer: str,
    case: Json,
    record: Json,
    digits: float | None,
) -> Failure | None:
    """Ask one case, count the outcome, and return the failure if there is one."""
    if layer not in player.layers:
        return None
    reply = player.ask(id, layer, case)
    outcome.implementation = player.declaration.implementation
    if layer not in player.layers:  # as it declared before its first answer
        return None
    if reply.kind == "output":
        with np.errstate(all="ignore"):  # answers may be any numbers
            verdict, output = answer_judged(
                layer, Case(id, "", case), record, reply.output, player.declaration, digits
            )
        outcome.verdicts[layer, verdict.verdict] += 1
        if verdict.verdict != FAILED:
            return None
        expected = record["output"]
        finding = Failure(id, layer, "wrong", verdict.field, verdict.reason, case, expected, output)
    else:
        outcome.verdicts[layer, reply.kind] += 1
        if reply.kind == "unsupported":
            return None
        finding = Failure(id, layer, reply.kind, "", reply.reason, case)
    outcome.findings.append(finding)
    return finding
