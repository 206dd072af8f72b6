"""What a check could not decide, and why."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.formats.quoting import listed, one_line
from quasistatic_ref.numbers.arrays import Array

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

TOO_MANY: Final = "too many contacts touch"
NO_ANSWER: Final = "a slow step has no answer"


class Undecided(NamedTuple):
    """A question about a scene or run that was not answered, and the reason.

    Parameters
    ----------
    what, why : str
    """

    what: str
    why: str


def undecided(what: str, reasons: Mapping[str, str]) -> Iterator[Undecided]:
    """The names to which each reason applies, as in ``equilibrium of a and b``.

    Parameters
    ----------
    what : str
        That is not known of the names.
    reasons : mapping of str to str
        Why, by name.
    """
    for why in dict.fromkeys(reasons.values()):
        names = [name for name, reason in reasons.items() if reason == why]
        yield Undecided(f"{what} of {listed(names)}", why)


def optimum(answer: OptimizeResult) -> Array:
    """The solution of a linear program that has one.

    Parameters
    ----------
    answer : scipy.optimize.OptimizeResult

    Returns
    -------
    ndarray, shape (n,)
        [any unit]

    Raises
    ------
    QuasistaticError
        If HiGHS fails, which then is said of the check that asked.
    """
    if answer.x is None:
        raise QuasistaticError(f"linprog: {answer.message}")
    return np.asarray(answer.x)


def failure(error: Exception) -> str:
    """The message of an exception, on one line."""
    return one_line(f"{type(error).__name__} {error}".rstrip())
