"""What failing answers have in common and right ones have not: where to look for a mistake.

Where no classic mistake explains what fails. Each number of the field that fails in most cases has
words (``words.py``). Said are the one to three conditions on them that tell wrong numbers from
right ones best, and in how many cases they do: it is a hint, which knows no mistake.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, combinations
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.check.compare import (
    number_problem,
    parts,
    shape_problem,
    tolerance_of,
)
from quasistatic_ref.lab.vectors.check.freedoms import aligned
from quasistatic_ref.lab.vectors.check.mistakes import Failed
from quasistatic_ref.lab.vectors.check.words import Words, words_of_numbers
from quasistatic_ref.lab.vectors.trees import nodes

LEAST = 3
"""Failing cases for each thing that is said of them: of fewer chance finds as much."""
MOST = 3
"""Things that are said; the last one is chosen by itself."""
HELD = 0.7
"""Share of the failing cases in which it has to be true."""
SPOILED = 1.0
"""Right cases of which the same is true, by failing ones, beyond which nothing is said."""
LEFT = 0.85
"""Share of the cost of saying nothing that what is said may have."""
USUAL = 0.6
"""Share of the failing cases that have a word that is tried."""
ALTERNATIVES = 3
"""Values of one kind, as of joints, that are said together."""
EXCEPTIONS = 4
"""Values of one kind that are excepted together."""
SAME = 1e-6
"""Relative spread of a ratio that is one number."""
Numbers = Sequence[set[Words]]
"""By case, the words of its numbers."""


@dataclass(frozen=True)
class Number:
    """A number that is given.

    Parameters
    ----------
    words : set of str
    fails : bool
        Whether it is wrong.
    ratio : float
        What it is of the expected one [-].
    """

    words: Words
    fails: bool
    ratio: float = np.nan


@dataclass(frozen=True)
class Condition:
    """Words of a number: one of some, or none of some others."""

    text: str
    words: Words
    wanted: bool = True

    @property
    def price(self) -> float:
        """How many cases it has to explain to be worth its words [-]."""
        return 2 * len(self.words) if self.wanted else 3 + len(self.words)

    def holds(self, words: Words) -> bool:
        """Whether it is true of a number with such words."""
        return (not self.words.isdisjoint(words)) == self.wanted


def common_of(layer: str, failed: Sequence[Failed], right: Sequence[Failed]) -> str:
    """One sentence on what failing cases have and nearly no right one has; often empty.

    Parameters
    ----------
    layer : str
    failed, right : sequence of Failed
        Its cases; those that fail may have no output.
    """
    fields = Counter(one.verdict.field for one in failed)
    field = max(fields, key=lambda name: fields[name], default="")
    mine = [one for one in failed if one.verdict.field == field]
    if len(mine) < LEAST:
        return ""
    numbers = [[*_numbers(layer, one, field)] for one in mine]
    wrong = [{one.words for one in case if one.fails} for case in numbers]
    correct = [{one.words for one in case if not one.fails} for case in numbers]
    others = [
        {words for _, words in words_of_numbers(one.case, one.record["output"], field)}
        for one in right
    ]
    known = _conditions(wrong, others)

    def cost(some: tuple[Condition, ...]) -> tuple[float, int, str]:
        missed = len(wrong) - _count(some, wrong)
        spoiled = _count(some, others) + _count(some, correct) / 2
        text = " and ".join(one.text for one in some)
        return 3 * missed + spoiled + sum(one.price for one in some), len(text), text

    best: tuple[Condition, ...] = ()
    for number in range(1, min(MOST, len(mine) // LEAST) + 1):
        longer = combinations(known, number) if number < MOST else ((*best, one) for one in known)
        best = min([best, *longer] if best else longer, key=cost, default=best)
    held = _count(best, wrong)
    spoiled = _count(best, others)
    too_dear = cost(best)[0] > LEFT * cost(())[0]
    if not best or too_dear or held < HELD * len(wrong) or spoiled > SPOILED * held:
        return ""
    what = f"{field} is wrong" if field else "no output is answered"
    return (
        f"{what} with {cost(best)[-1]} in {held} "
        f"of {len(failed)} failing cases, and right with that in {spoiled} of {len(right)} others"
        f"{_relation(chain(*numbers))}"
    )


def _conditions(wrong: Numbers, others: Numbers) -> list[Condition]:
    """Words that most have; a few values of a kind; all but a few that none has."""
    seen = Counter(word for one in wrong for word in frozenset().union(*one))
    theirs = Counter(word for one in others for word in frozenset().union(*one))
    usual = [word for word in seen if seen[word] >= USUAL * len(wrong)]
    found = [Condition(word.replace(":", ""), frozenset({word})) for word in usual]
    kinds = defaultdict(set)
    for word in {*seen, *theirs}:
        kinds[word.rpartition(": ")[0]].add(word)
    del kinds[""]
    for kind, values in kinds.items():
        own = sorted(values & seen.keys(), key=lambda one: (theirs[one] / seen[one], one))
        for number in range(2, min(len(own), ALTERNATIVES) + 1):
            some = frozenset(own[:number])
            found.append(Condition(f"{kind} {_listed(some)}", some))
        never = frozenset(values - seen.keys())
        if 0 < len(never) <= EXCEPTIONS and own:
            found.append(Condition(f"{kind} not {_listed(never)}", never, wanted=False))
    return sorted(found, key=lambda one: one.text)


def _listed(words: Iterable[str]) -> str:
    """Values of a kind."""
    return " or ".join(sorted(word.rpartition(": ")[2] for word in words))


def _count(some: Sequence[Condition], cases: Numbers) -> int:
    """In how many cases all is true of a number."""
    return sum(any(all(one.holds(words) for one in some) for words in case) for case in cases)


def _numbers(layer: str, one: Failed, field: str) -> Iterator[Number]:
    """Those of a field of a failing case; where it has no such field, the case as one number."""
    output = one.record["output"]
    answer = one.output if isinstance(one.output, dict) else {}
    if shape_problem(layer, output, answer) is None:
        answer = aligned(layer, one.case, output, answer)
    expected = dict(nodes(parts(output).get(field)))
    given = dict(nodes(parts(answer).get(field)))
    limit = tolerance_of(one.record["tolerance"], field)
    for path, words in words_of_numbers(one.case, output, field):
        value = expected[path]
        other: Any = given.get(path)
        finite = isinstance(other, int | float) and number_problem(other, "") is None
        if isinstance(value, float) and finite:
            fails = not abs(value - other) <= limit
            yield Number(words, fails, float(other) / value if value else np.nan)
        else:
            yield Number(words, value is None or value != other)


def _relation(numbers: Iterable[Number]) -> str:
    """What wrong numbers are of the expected ones, where that is one thing in all cases."""
    ratios = [one.ratio for one in numbers if one.fails]
    if not np.ptp(ratios) <= SAME * np.abs(ratios[0]):
        return ""
    return f"; what is wrong is {ratios[0]:.6g} times the expected"
