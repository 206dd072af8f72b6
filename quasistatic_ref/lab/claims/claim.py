"""What a claim is, what was measured for it, and the verdict."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array

HOLDS = "holds"
FAILS = "FAILS"
NOT_RUN = "not run (engine not installed)"


@dataclass(frozen=True, eq=False)
class Comparison:
    """One quantity over a sweep: its measured and its expected values.

    Parameters
    ----------
    what : str
        The quantity, with its unit in brackets.
    measured, expected : ndarray, shape (points,)
        [unit of `what`].
    scale : ndarray, shape (points,)
        What an error is relative to: the largest term of the formula, or 1 [the same].
    tolerance : float
        Largest |measured - expected| / scale that is still agreement; 0 asks for equal bits.
    words : str
        The expectation in words, where it is no single number.
    """

    what: str
    measured: Array
    expected: Array
    scale: Array
    tolerance: float
    words: str = ""

    @property
    def errors(self) -> Array:
        """Each point's error over its scale, shape (points,); NaN where something is no number."""
        gap = np.abs(self.measured - self.expected)
        # A scale of zero forgives nothing: all terms are zero, and so must the measurement be.
        return np.where(gap == 0, 0.0, gap / np.where(self.scale > 0, self.scale, 1e-300))

    @property
    def worst(self) -> int:
        """Index of the point with the largest error; of the largest expectation among ties."""
        errors = np.where(np.isnan(self.errors), np.inf, self.errors)
        return int(np.lexsort((np.abs(self.expected), errors))[-1])

    @property
    def holds(self) -> bool:
        """Whether every point agrees; NaN never does, nor does a sweep without points."""
        return bool(self.errors.size and (self.errors <= self.tolerance).all())


def comparison(
    what: str,
    measured: ArrayLike,
    expected: ArrayLike,
    tolerance: float,
    scale: ArrayLike = 1.0,
) -> Comparison:
    """A comparison of arrays of any shape; the scale is broadcast to them.

    Parameters
    ----------
    what : str
    measured, expected : array_like
        Of equal shape, or either of them one number.
    tolerance : float
    scale : array_like
    """
    arrays = np.broadcast_arrays(*(np.asarray(a, float) for a in (measured, expected, scale)))
    m, e, s = (array.ravel() for array in arrays)
    return Comparison(what, m, e, np.abs(s), tolerance)


def sum_of_terms(
    what: str, measured: ArrayLike, terms: Sequence[ArrayLike], tolerance: float
) -> Comparison:
    """A comparison with the sum of some terms, relative to the largest of them."""
    stacked = np.array(np.broadcast_arrays(*(np.asarray(t, float) for t in terms)))
    return comparison(what, measured, stacked.sum(0), tolerance, np.abs(stacked).max(0))


def within(what: str, measured: ArrayLike, low: float, high: float) -> Comparison:
    """The claim that measurements lie in an interval, from low to high [unit of `what`]."""
    m = np.atleast_1d(np.asarray(measured, float))
    words = f"{low:g} to {high:g}" if np.isfinite(high) else f"at least {low:g}"
    return Comparison(what, m, np.clip(m, low, high), np.ones_like(m), 0.0, words)


@dataclass(frozen=True)
class Claim:
    """A sentence about the model that measurements can refute.

    Parameters
    ----------
    name : str
        That by which `validate` knows it.
    sentence : str
    where : str
        The paper's page or figure, a publication, or (R#) of docs/derivations.md.
    sweep : str
        What was varied.
    reason : str
        Why the tolerances are what they are.
    measure : callable
        Returns the comparisons that were made for it.
    engine : str, optional
        A distribution without which it cannot be measured: its version is a part of the finding.
    setting : str
        At which settings that engine runs; others are its defaults.
    """

    name: str
    sentence: str
    where: str
    sweep: str
    reason: str
    measure: Callable[[], list[Comparison]]
    engine: str | None = None
    setting: str = ""

    @property
    def engine_version(self) -> str | None:
        """The engine's name, version and setting: "" if it needs none, None if there is none."""
        if self.engine is None:
            return ""
        try:
            version = metadata.version(self.engine)
        except metadata.PackageNotFoundError:
            return None
        return ", ".join(filter(None, (f"{self.engine} {version}", self.setting)))


@dataclass(frozen=True, eq=False)
class ClaimResult:
    """A claim with what was measured for it.

    Parameters
    ----------
    claim : Claim
    comparisons : list of Comparison or None
        None where nothing could be measured.
    trouble : str
        Why not: an error of the package, which fails the claim; empty where only the engine is
        missing.
    seconds : float
        What measuring took [s].
    """

    claim: Claim
    comparisons: list[Comparison] | None
    trouble: str = ""
    seconds: float = 0.0

    @property
    def verdict(self) -> str:
        """``HOLDS``, ``FAILS`` or ``NOT_RUN``."""
        if self.comparisons is None:
            return FAILS if self.trouble else NOT_RUN
        return HOLDS if self.comparisons and all(c.holds for c in self.comparisons) else FAILS


def claim_result(claim: Claim) -> ClaimResult:
    """Measure a claim, or say that its engine is missing."""
    if claim.engine_version is None:
        return ClaimResult(claim, None)
    start = time.perf_counter()
    comparisons = None
    trouble = ""
    try:
        comparisons = claim.measure()
    except QuasistaticError as error:  # a wrong formula may well make a step unsolvable
        trouble = str(error)
    return ClaimResult(claim, comparisons, trouble, time.perf_counter() - start)
