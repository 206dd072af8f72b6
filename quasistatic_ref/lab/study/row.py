"""One measurement of a study: the columns of its Parquet file."""

from dataclasses import dataclass
from typing import Any

COLD, WARM = STARTS = ("cold", "warm")
SOLVED = "solved"
"""It says that it solved the problem, and returned numbers."""
FAILED = "failed"
"""It says otherwise, or raised."""
NAN = "not a number"
"""It says that it solved the problem, and returned numbers that are not finite."""
WRONG_SHAPE = "wrong shape"
CRASHED = "crashed"
TIMEOUT = "timeout"
MEMORY = "out of memory"
NOT_RUN = "not run"
"""Its budget was used up before."""
OUTCOMES = (SOLVED, FAILED, NAN, WRONG_SHAPE, CRASHED, TIMEOUT, MEMORY, NOT_RUN)


@dataclass(frozen=True)
class Row:
    """One problem, put to one solver at one setting. None: not known, or not judged.

    Parameters
    ----------
    problem, family : str
        Name of the problem, and its first part.
    n, m : int
        Coordinates and rows [-].
    dial : float or None
        Where the family's dial stands [the dial's unit].
    feasible : bool
        Whether the problem has a solution.
    solver, door : str
        Its name in the study; ``"qpsolvers"``, ``"cvxpy"`` or ``"function"``. In rows of earlier
        versions, which had a door for it, also ``"native"``: its own interface.
    version : str
        Of its package.
    setting, options : str
        Name of the setting, and the options that the solver was given, as JSON.
    units : str
        Of the call: ``"raw"`` (SI) or ``"natural"``.
    start : str
        ``"cold"``, or ``"warm"``: from its answer to the step before, or to a neighbour. In rows of
        ``"native"``, what was kept of the step before.
    started : bool
        Whether there was such an answer, of a solver that said that it solved.
    outcome : str
        One of ``OUTCOMES``.
    status : str
        The solver's own word, or what it raised.
    claim : str
        ``"optimal"``, ``"infeasible"``, ``"neither"``, or ``"hidden"``: not handed on.
    false_claim : bool
        Whether a residual exceeds its limit, or there is a solution.
    digits, digits_net, digits_lam : float or None
        Correct digits of x, of A'lam and of the multipliers [-].
    primal, dual, gap : float or None
        Residuals [m, N s and N m s, N m s; in natural units -].
    primal_limit, dual_limit, gap_limit : float or None
        The largest that the solver's promise allows [as the residuals].
    seconds, seconds_low, seconds_high : float or None
        Of a whole call: the median of several, and their quartiles [s].
    seconds_first : float or None
        Of the call that was judged, the first on this problem; the limit, where it was ended [s].
    seconds_solver, seconds_setup : float or None
        Of that call, by the solver's own account [s].
    calls : int
        That were timed [-].
    iterations : int or None
        By its own account [-].
    memory : float or None
        Largest resident memory that was seen of its process, and of what that started [bytes].
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
    options: str
    units: str
    start: str
    started: bool
    outcome: str
    status: str
    claim: str
    false_claim: bool
    digits: float | None
    digits_net: float | None
    digits_lam: float | None
    primal: float | None
    dual: float | None
    gap: float | None
    primal_limit: float | None
    dual_limit: float | None
    gap_limit: float | None
    seconds: float | None
    seconds_low: float | None
    seconds_high: float | None
    seconds_first: float | None
    seconds_solver: float | None
    seconds_setup: float | None
    calls: int
    iterations: int | None
    memory: float | None
    machine: str


KEY = ("problem", "solver", "door", "setting", "options", "units", "start")
"""Columns that tell one measurement from another: a row that is there is not measured again."""


def key_of(row: Any) -> tuple[str, ...]:
    """What tells a row, or a measurement that has these attributes, from others."""
    return tuple(getattr(row, name) for name in KEY)
