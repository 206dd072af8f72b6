"""One call of a study: the columns of its Parquet file."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """A problem put to a solver at a setting, and what came back; None: not known.

    Parameters
    ----------
    problem, family : str
        Name of the problem, and the family that it is of.
    n, m : int
        Coordinates and rows [-].
    dial : float or None
        Where the family's dial stands [the dial's unit].
    feasible : bool
        Whether the problem has a solution.
    solver, door : str
        Name of the solver in the study; ``"qpsolvers"``, ``"cvxpy"`` or ``"function"``. Rows of an
        earlier version may have ``"native"``: the solver's own interface.
    version : str
        Of the solver's package.
    setting : str
    accuracy : float or None
        That the solver was asked for, in the units of the call [-].
    options : str
        That the solver was given, as JSON.
    units : str
        Of the call: ``"raw"`` (as the problem is given) or ``"natural"``.
    status : str
        The solver's own word, what it raised, or why it was ended.
    says : str
        What this word means: ``"solved"``, ``"infeasible"`` or ``"other"``.
    primal, dual, gap : float or None
        Residuals of the answer in natural units, whichever units the call had [-].
    reached : bool or None
        Whether each residual is at most the accuracy; False of a call without an answer, None where
        no accuracy was asked for.
    digits : float or None
        Correct digits of x [-].
    seconds : float or None
        Of a call, the median of several; of one that was ended, until then [s].
    machine : str
        Its processor.
    """

    problem: str
    family: str
    n: int
    m: int
    dial: float | None
    feasible: bool
    solver: str
    door: str
    version: str
    setting: str
    accuracy: float | None
    options: str
    units: str
    status: str
    says: str
    primal: float | None
    dual: float | None
    gap: float | None
    reached: bool | None
    digits: float | None
    seconds: float | None
    machine: str


KEY = ("problem", "solver", "door", "setting", "options", "units")
"""Columns that tell one call from another: a call that has a row is not made again."""


def key_of(row: Any) -> tuple[str, ...]:
    """The attributes that identify a row of a study, or a call that would make it."""
    return tuple(getattr(row, name) for name in KEY)
