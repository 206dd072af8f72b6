"""What papers compare solvers by: performance profiles, and shifted geometric means of times.

A call *solves* its problem if it delivers six digits (page.py); rows are those of problems with a
solution, as pandas has them.
"""

from typing import Any, Final

import numpy as np

from quasistatic_ref.lab.study.limits import Limits

SIX: Final = 6.0
"""Correct digits that a simulation wants [-]."""
SHIFT: Final = 10.0
"""That of qpbenchmark, and of Mittelmann's benchmarks [s]."""
UNSOLVED: Final = Limits().time_limit
"""What a call that does not solve counts as, as in qpbenchmark: the limit of a call [s]."""
FACTORS: Final = (1.0, 2.0, 5.0, 10.0, 100.0)
"""Times of the fastest at which the table shows a profile [-]."""
CALLED = ["label", "setting", "options"]
"""Columns that tell one way to call a solver from another."""


def counted_seconds(calls: Any) -> Any:
    """The time as which each call counts in a mean [s].

    Parameters
    ----------
    calls : pandas.DataFrame
        Columns ``seconds`` and ``delivered``, the digits [-].
    """
    return calls["seconds"].astype(float).where(calls["delivered"] >= SIX).fillna(UNSOLVED)


def shifted_mean(seconds: Any) -> float:
    """The shifted geometric mean of times [s].

    It is exp(mean(log(t + s))) - s with s = ``SHIFT``, as qpbenchmark forms it.

    Parameters
    ----------
    seconds : pandas.Series
    """
    return float(SHIFT * np.expm1(np.log1p(seconds / SHIFT).mean()))


def time_ratios(calls: Any, shown: Any) -> Any:
    """Each call's time over that of the fastest call that solves the problem [-].

    Dolan and Moré (2002): the profile of a solver is the share of its problems with a ratio of at
    most a factor.

    Parameters
    ----------
    calls : pandas.DataFrame
    shown : pandas.DataFrame
        The ways to call solvers that are compared, by columns ``CALLED``.

    Returns
    -------
    pandas.DataFrame
        ``label`` and ``ratio``, infinite where the call does not solve.
    """
    compared = calls.merge(shown[CALLED], on=CALLED)
    seconds = compared["seconds"].astype(float).where(compared["delivered"] >= SIX)
    fastest = seconds.groupby(compared["problem"]).transform("min")
    return compared[["label"]].assign(ratio=(seconds / fastest).fillna(np.inf))


def profile_shares(ratios: Any) -> Any:
    """The share of its problems that each solver solves within ``FACTORS``, and at all [%].

    Parameters
    ----------
    ratios : pandas.DataFrame
        Of :func:`time_ratios`.

    Returns
    -------
    pandas.DataFrame
        A line a solver, the first the one that solves most; a column a factor.
    """
    table = ratios[["label"]].assign(
        **{f"{factor:g} x": 100.0 * (ratios["ratio"] <= factor) for factor in FACTORS},
        **{"any time": 100.0 * np.isfinite(ratios["ratio"])},
    )
    shares = table.groupby("label", sort=False).mean()
    return shares.sort_values([*reversed(shares.columns)], ascending=False)
