"""The few statistics of a report: shares, means of times, performance profiles."""

import numpy as np

SHIFT = 1e-3
"""Of the shifted geometric mean [s]: what is far faster than that counts alike."""

TICK = 1e-9
"""Shortest time that a clock distinguishes [s]: a call of no time at all took that long."""
SAMPLES = 400
"""Of a bootstrap."""
LOW = 1.0
"""The percentile that stands for "nearly the worst"."""


def shifted_geometric_mean(seconds: np.ndarray) -> float:
    """exp(mean(log(t + s))) - s: a mean that neither the slowest nor the fastest calls rule.

    Parameters
    ----------
    seconds : ndarray, shape (n,) [s]

    Returns
    -------
    float [s]
    """
    return float(np.exp(np.log(seconds + SHIFT).mean()) - SHIFT)


def success(digits: np.ndarray, least: float) -> float:
    """Share of answers with at least so many digits [%]."""
    return 100 * float(np.mean(digits >= least))


def performance_ratios(seconds: np.ndarray, good: np.ndarray) -> np.ndarray:
    """How many times longer than the fastest solver each one took on each problem.

    After Dolan & More, Benchmarking optimization software with performance profiles, Math.
    Program. 91 (2002): the profile of solver s at tau is the share of problems whose ratio is at
    most tau.

    Parameters
    ----------
    seconds : ndarray, shape (solvers, problems) [s]
    good : ndarray of bool, shape (solvers, problems)
        Whether the answer is good enough; one that is not counts as never given.

    Returns
    -------
    ndarray, shape (solvers, problems) [-]
        At least 1; infinite where the answer is not good enough.
    """
    times = np.where(good, np.maximum(seconds, TICK), np.inf)
    fastest = times.min(axis=0, initial=np.inf)
    ratios = np.full(times.shape, np.inf)
    np.divide(times, fastest, out=ratios, where=np.isfinite(times))
    return ratios


def resampled_means(values: np.ndarray, strata: np.ndarray) -> np.ndarray:
    """Means of values over problems that are drawn again, with replacement, within each stratum.

    Parameters
    ----------
    values : ndarray, shape (n,)
        In any unit [any].
    strata : ndarray of str, shape (n,)
        The family of each problem [-].

    Returns
    -------
    ndarray, shape (SAMPLES,)
        In the same unit; the same for the same arguments.
    """
    rng = np.random.default_rng(0)
    total = np.zeros(SAMPLES)
    for stratum in np.unique(strata):
        own = values[strata == stratum]
        total += own[rng.integers(len(own), size=(SAMPLES, len(own)))].sum(axis=1)
    return np.asarray(total / len(values))


def interval(samples: np.ndarray) -> tuple[float, float]:
    """The interval that holds 95 % of bootstrap samples, shape (SAMPLES,) [any]."""
    low, high = np.percentile(samples, [2.5, 97.5])
    return float(low), float(high)
