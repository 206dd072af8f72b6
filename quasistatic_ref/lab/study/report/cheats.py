"""Rows that look like those of no honest solver; a report names them."""

import numpy as np

from quasistatic_ref.certify.norm import MOST
from quasistatic_ref.lab.study.report.rows import Rows
from quasistatic_ref.lab.study.report.statistics import TICK, success

REMEMBERED = 4.0
"""A first call that takes so many times longer than the same call repeated: it was remembered...
Of honest solvers it takes at most 4 times as long, on caches that hold other problems..."""
COLD = 2e-4
"""...which costs the quickest that much, and is taken off a first call [s]."""
KNOWN = 99.0
"""Share of answers that are the correctly rounded ones [%] above which they are not computed in
floats: of solvers in float64 at most 15 % are."""
REPEATED = 50.0
"""Share of steps whose answer is the last one again, or answers the step before [%], though the
exact one is another: of honest solvers none does."""


def cheat_alone(rows: Rows) -> str:
    """What the rows of a solver on problems that were solved alone look like; else empty."""
    own = rows.at(solved=True)
    timed = own.kept(lambda row: bool(np.isfinite(row["first"])))
    ratios = (timed["first"] - COLD) / np.maximum(timed["call"], TICK)
    if len(own) and success(own["digits"], MOST) > KNOWN:
        return "has the exact answers"
    if _mostly(own, "repeats", True):
        return "knows the problems, and no others"
    if len(timed) and np.median(ratios) > REMEMBERED:
        return "remembers the last problem, or knows the problems"
    if _mostly(own, "clock_agrees", False):
        return "stops the clock"
    return ""


def _mostly(rows: Rows, name: str, value: bool) -> bool:
    """Whether a field, where it is known, mostly has a value."""
    known = rows.kept(lambda row: row[name] is not None)
    return len(known) > 0 and 100 * float(np.mean(known[name] == value)) > REPEATED


def cheat_in_order(rows: Rows) -> str:
    """What the rows of a solver on steps in order look like; else empty."""
    return "returns its last answer again" if _mostly(rows, "repeats", True) else ""
