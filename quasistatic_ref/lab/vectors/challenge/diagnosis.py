"""What of a program's answers is wrong, and why.

After each round, what failed is named by all that was seen so far of its layer, and the smallest
failing case is made smaller.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from quasistatic_ref.lab.vectors.challenge.findings import Finding
from quasistatic_ref.lab.vectors.challenge.fresh import HARD, PLAIN, record_of
from quasistatic_ref.lab.vectors.challenge.function import Function
from quasistatic_ref.lab.vectors.challenge.outcome import Outcome
from quasistatic_ref.lab.vectors.challenge.program import FLOOD, Program, Reply
from quasistatic_ref.lab.vectors.challenge.simpler import shrunk
from quasistatic_ref.lab.vectors.check.folder import answer_judged
from quasistatic_ref.lab.vectors.check.mistakes import Failed, is_explained_by, mistakes_of
from quasistatic_ref.lab.vectors.check.report import Named
from quasistatic_ref.lab.vectors.check.usual import usual_sentence
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import Case
from quasistatic_ref.lab.vectors.layers import LAYERS

MORE = 12
"""Further cases of a layer in which something fails, by which it is named."""
MOST = 10
"""Findings that are written at most."""
GIVEN_UP = 3
"""Crashes, hangs, late answers or lines of garbage after which a layer gets no further cases."""

TROUBLES = ("crash", "hang", "late", "garbage")
"""What may take long."""

Task = tuple[str, tuple[int, ...], int]
"""Layer, seed, level."""


class Diagnosis:
    """What is known of a program while it is challenged.

    Parameters
    ----------
    program : Program or Function
    digits : float or None
        [-].
    made : callable
        Cases of tasks, in their order.
    until : float
        By the monotonic clock, from when on nothing more is asked [s].
    """

    def __init__(
        self,
        program: Program | Function,
        digits: float | None,
        made: Callable[[Iterable[Task]], Iterator[tuple[Task, Json, Json]]],
        until: float = math.inf,
    ) -> None:
        self._until = until
        self.program = program
        self._digits = digits
        self._made = made
        self.outcome = Outcome()
        self._failed: dict[str, list[Failed]] = {name: [] for name in LAYERS}
        self._right: dict[str, list[Failed]] = {name: [] for name in LAYERS}
        self._known: set[tuple[str, str]] = set()
        self._troubles: Counter[str] = Counter()
        self._unsupported: dict[str, str] = {}
        self._wanted: set[str] = set()
        self._shrinks, self._began = 0, time.monotonic()

    @property
    def late(self) -> bool:
        """Whether its time is over."""
        return time.monotonic() >= self._until

    @property
    def full(self) -> bool:
        """Whether as much is found as is written."""
        return len(self.outcome.findings) >= MOST

    def goes_on(self, layer: str) -> bool:
        """Whether a layer gets further cases."""
        return self._supports(layer) and self._troubles[layer] < GIVEN_UP

    def _supports(self, layer: str) -> bool:
        answered = self.outcome.verdicts[layer, "unsupported"] < self.outcome.sent[layer]
        return layer in self.program.layers and answered

    def play(self, tasks: Sequence[Task]) -> None:
        """Ask one round, and look into what failed."""
        self._wanted |= {layer for layer, _, _ in tasks}
        self._ask(tasks)
        new = [layer for layer in LAYERS if self._new_failure(layer)]
        for layer in new:
            seed = (*tasks[0][1][:2], len(tasks))
            self._ask([(layer, (*seed, i), (PLAIN, HARD)[i % 2]) for i in range(MORE)])
        for layer in new:
            while (one := self._new_failure(layer)) and not self.full:
                self._add_finding(layer, one)

    def final_outcome(self) -> Outcome:
        """The outcome, with remarks."""
        self.outcome.implementation = self.program.said.implementation
        if self.program.flood > FLOOD:
            size = self.program.flood / 2**20
            self.outcome.remarks.append(f"it wrote {size:.1f} MiB on its standard error")
        if self.program.starts > 1:
            self.outcome.remarks.append(f"it was started {self.program.starts} times")
        wrong = [one for one in self.outcome.findings if one.kind == "wrong"]
        earliest = min(wrong, key=lambda one: LAYERS.index(one.layer), default=None)
        if earliest and not earliest.mistakes:
            self.outcome.remarks.append(usual_sentence(earliest.layer))
        for layer in LAYERS:
            if self._troubles[layer] >= GIVEN_UP:
                self.outcome.remarks.append(
                    f"{layer} got no further cases: {GIVEN_UP} cases came to no answer in time"
                )
            elif layer in self._wanted and not self.goes_on(layer):
                self.outcome.remarks.append(f"{layer} is not supported")
            elif count := self.outcome.verdicts[layer, "unsupported"]:
                first = self._unsupported[layer]
                self.outcome.remarks.append(
                    f"{layer}: {count} cases are not supported, {first} is the first"
                )
        return self.outcome

    def _ask(self, tasks: Sequence[Task]) -> None:
        for (layer, seed, level), case, record in self._made(tasks):
            if self.late:
                return
            if self._troubles[layer] >= GIVEN_UP or layer not in self.program.layers:
                continue
            self.outcome.sent[layer] += 1
            id = "/".join((layer, ("easy", "plain", "hard")[level], "-".join(map(str, seed))))
            self.ask(id, layer, case, record)

    def ask(self, id: str, layer: str, case: Json, record: Json) -> None:
        """Ask one case, and keep what came of it."""
        reply = self.program.ask(id, layer, case)
        if layer not in self.program.layers:  # as it declared before its first answer
            self.outcome.sent[layer] -= 1
            return
        for said in reply.strays:
            self._trouble("stray", layer, id, said, case)
        if reply.kind != "output":
            self.outcome.verdicts[layer, reply.kind] += 1
            if reply.kind == "unsupported":
                self._unsupported.setdefault(layer, id)
            else:
                self._troubles[layer] += reply.kind in TROUBLES
                self._trouble(reply.kind, layer, id, reply.said, case)
            return
        one = self._judgement(id, layer, case, record, reply)
        self.outcome.verdicts[layer, one.verdict.verdict] += 1
        if one.verdict.verdict == FAILED:
            self._note_time()
        (self._failed if one.verdict.verdict == FAILED else self._right)[layer].append(one)

    def _note_time(self) -> None:
        self.outcome.found_after = min(self.outcome.found_after, time.monotonic() - self._began)

    def _judgement(self, id: str, layer: str, case: Json, record: Json, reply: Reply) -> Failed:
        with np.errstate(all="ignore"):  # answers may be any numbers
            whole = Case(id, "", case)
            said = self.program.said
            return answer_judged(layer, whole, record, reply.output, said, self._digits)

    def _trouble(self, kind: str, layer: str, id: str, said: str, case: Json) -> None:
        """A finding without an answer: once by layer and kind, its case made smaller."""
        if (layer, kind) in self._known or self.full:
            return
        self._note_time()
        self._known.add((layer, kind))
        if kind in ("error", "crash"):
            case = shrunk(case, lambda other: self._replies(layer, other, kind), 60)
        self.outcome.findings.append(
            Finding(layer, kind, "", (), (), f"{kind}: {said}", case, None, None, id, 1)
        )

    def _replies(self, layer: str, case: Json, kind: str) -> bool:
        if self.late or record_of(layer, case) is None:
            return False
        return self._reply_again(layer, case).kind == kind

    def _reply_again(self, layer: str, case: Json) -> Reply:
        self._shrinks += 1
        return self.program.ask(f"{layer}/smaller/{self._shrinks}", layer, case)

    def _new_failure(self, layer: str) -> Failed | None:
        """The smallest failure of a field that is not yet known."""
        new = [one for one in self._failed[layer] if (layer, one.verdict.field) not in self._known]
        return min(new, key=lambda one: len(str(one.case)), default=None)

    def _add_finding(self, layer: str, one: Failed) -> None:
        """Name a failure and make its case smaller."""
        at = one.verdict.field
        same = [other for other in self._failed[layer] if other.verdict.field == at]
        self._known.add((layer, at))
        with np.errstate(all="ignore"):
            named = mistakes_of(layer, same, self._right[layer])
            same_way = [o for o in same if self._is_explained(layer, named, o)] or [one]
            one = min(same_way, key=lambda o: len(str(o.case)))
            best = [one]

            def fails(case: Json) -> bool:
                record = None if self.late else record_of(layer, case)
                reply = self._reply_again(layer, case) if record is not None else Reply("none")
                if reply.kind != "output":
                    return False
                other = self._judgement(one.id, layer, case, record, reply)
                if other.verdict.verdict != FAILED or other.verdict.field != at:
                    return False
                if named and not self._is_explained(layer, named, other):
                    return False
                best[0] = other
                return True

            shrunk(one.case, fails)
        names, sentences = (tuple(getattr(m, key) for m in named) for key in ("name", "sentence"))
        self._add(layer, best[0], names, sentences, one.id, len(same))

    def as_before(self, layer: str, names: tuple[str, ...], sentences: tuple[str, ...]) -> None:
        """Add what failed in a layer as findings whose names are known."""
        for one in self._failed[layer]:
            self._add(layer, one, names, sentences, one.id, 1)

    def _add(
        self,
        layer: str,
        one: Failed,
        names: tuple[str, ...],
        sentences: tuple[str, ...],
        first: str,
        cases: int,
    ) -> None:
        self.outcome.findings.append(
            Finding(
                layer, "wrong", one.verdict.field, names, sentences, one.verdict.reason,
                one.case, one.record["output"], one.output, first, cases,
            )
        )  # fmt: skip

    def _is_explained(self, layer: str, named: Sequence[Named], one: Failed) -> bool:
        return any(is_explained_by(layer, name.name, one) for name in named)
