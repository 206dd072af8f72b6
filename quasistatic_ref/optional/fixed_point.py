"""A fixed point of a map that is piecewise linear: its iterates, extrapolated (Anderson 1965)."""

from collections.abc import Callable, Sequence
from typing import Final, Generic, NamedTuple, TypeVar

import numpy as np

from quasistatic_ref.numbers.arrays import Array

GAIN: Final = 0.01
"""Residual of s over that of the iterate before [-] up to which an extrapolated iterate is kept.
Kept at 0.5, extrapolation ended at local minima of the residual in 29 of 600 random planar steps of
one to four contacts; at 0.01 in none of 500."""

EXTRAPOLATED: Final = 1e-10
"""Least singular value, relative to the largest [-], of the changes of residuals that s is
extrapolated from: they are right to 1e-16 of s, and what is left of smaller ones is rounding."""

MEMORY: Final = 6
"""Iterates that are extrapolated from: s then has five directions in which it converges slowly."""

T = TypeVar("T")


class Iterate(NamedTuple, Generic[T]):
    """One iterate: a point, and the value of the map there.

    Parameters
    ----------
    s, image : ndarray, shape (n,)
        What the map was asked for, and its value there [both of any unit].
    residual : float
        The largest difference of the two [their unit].
    converged : bool
        Whether that is rounding.
    of : object
        What the value was read of.
    """

    s: Array
    image: Array
    residual: float
    converged: bool
    of: T


def fixed_point(at: Callable[[Array], Iterate[T]], s: Array, most: int) -> tuple[Iterate[T], int]:
    """The fixed point that `s` leads to, or the last of `most` iterates; and how many they were.

    An extrapolated iterate counts only if its residual is a hundredth of that of the last one.
    Otherwise the next iterate is the value at the last one, whatever its residual: a residual may
    have to grow before it vanishes.

    Parameters
    ----------
    at : callable
        s >= 0, shape (n,) -> its iterate.
    s : ndarray, shape (n,)
        Where to start [any unit].
    most : int
    """
    last = at(s)
    count = 1
    kept = [last]
    while not last.converged and count < most:
        ahead = extrapolated(kept)
        tried = None if ahead is None else at(np.maximum(ahead, 0.0))
        count += tried is not None
        if tried is not None and tried.residual <= GAIN * last.residual:
            last = tried
        elif count < most:
            last = at(last.image)
            count += 1
        kept = [*kept[1 - MEMORY :], last]
    return last, count


def extrapolated(iterates: Sequence[Iterate[T]]) -> Array | None:
    """Where s would be its own value if that depended linearly on it, shape (n,).

    Least squares take the place of an equation; None of one iterate, or if nothing is gained.
    """
    off = np.array([x.image - x.s for x in iterates])
    images = np.array([x.image for x in iterates])
    if len(iterates) == 1:
        return None
    changes = np.diff(off, axis=0).T
    share = np.linalg.lstsq(changes, off[-1], rcond=EXTRAPOLATED)[0]
    s = np.maximum(images[-1] - np.diff(images, axis=0).T @ share, 0.0)
    return None if np.array_equal(s, images[-1]) else s
