"""What a check could not decide, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.text.quoting import one_line

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult


class Undecided(NamedTuple):
    """A question about a scene or run that was not answered, and the reason.

    Parameters
    ----------
    what, why : str
    """

    what: str
    why: str


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
