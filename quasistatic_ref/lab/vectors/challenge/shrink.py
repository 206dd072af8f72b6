"""A failing case made smaller, by moves after each of which it fails in the same way."""

from collections.abc import Callable
from typing import Final

from quasistatic_ref.lab.vectors.challenge.simpler import MOVES
from quasistatic_ref.lab.vectors.expected import Json

BUDGET: Final = 250
"""At most so many inputs are tried."""


def shrunk(case: Json, fails: Callable[[Json], bool], budget: int = BUDGET) -> Json:
    """The smallest input that is found: no single move makes it smaller, or the budget is spent.

    Parameters
    ----------
    case : dict
        An input that fails.
    fails : callable
        Whether an input is valid and fails in the same way.
    budget : int
        How often `fails` may be called.
    """
    tried: set[str] = {repr(case)}
    again = True
    while again:
        again = False
        for move in MOVES:
            found = True
            while found:
                found = False
                for other in move(case):
                    key = repr(other)
                    if key in tried:
                        continue
                    if len(tried) > budget:
                        return case
                    tried.add(key)
                    if fails(other):
                        case = other
                        found = True
                        again = True
                        break
    return case
