"""Fixed points of many maps at once: as :mod:`~quasistatic_ref.optional.fixed_point`, in step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.fixed_point import EXTRAPOLATED, MEMORY

GAIN = 0.5
"""Residual of s over that of the iterate before [-] up to which an extrapolated iterate is kept: of
random maps more are found than at a hundredth, in less time."""
LEAP = 4.0
"""Iterates [-] that are passed over where s creeps: each time as many times more."""
SAME = 1e-3
"""Change of a residual [-] that is none."""


class Iterates(NamedTuple):
    """One iterate of each of b maps: a point, and the value of the map there.

    Parameters
    ----------
    s, image : ndarray, shape (b, c)
        What the map was asked for, and its value there [both of any unit].
    residual : ndarray, shape (b,)
        The largest difference of the two [their unit]; infinite where there is no value.
    own : ndarray of bool, shape (b,)
        Whether that is rounding.
    delta_q, forces : ndarray, shapes (b, n) and (b, c, 4)
        What the value was read of [m, rad] and [N, N m].
    """

    s: Array
    image: Array
    residual: Array
    own: Mask
    delta_q: Array
    forces: Array


At = Callable[[Indices, Array], Iterates]


def fixed_points(at: At, s: Array, most: int) -> Iterates:
    """The fixed points that `s`, (b, c), lead to, or the last of `most` iterates.

    An extrapolated iterate counts only if its residual is half of that of the last one; and where
    s creeps, since residuals do not change, it leaps ahead.

    Parameters
    ----------
    at : callable
        Numbers of maps, (k,), and s >= 0, (k, c) -> their iterates.
    s : ndarray, shape (b, c)
        Where to start [any unit].
    most : int
    """
    last = at(np.arange(len(s)), s)
    count = np.ones(len(s), dtype=np.int64)
    leap = np.full(len(s), LEAP)
    kept = [(last.s.copy(), last.image.copy())]

    def take(of: Indices, new: Iterates) -> None:
        for array, values in zip(last, new, strict=True):
            array[of] = values

    while True:
        left = np.flatnonzero(~last.own & (count < most) & np.isfinite(last.residual))
        if not left.size:
            return last
        images = np.array([image[left] for _, image in kept])
        off = images - np.array([point[left] for point, _ in kept])
        creeps = np.zeros(len(left), dtype=bool)
        ahead = images[-1]
        if len(kept) > 1:
            change = np.abs(off[-1] - off[-2]).max(axis=1, initial=0.0)
            creeps = change <= SAME * last.residual[left]
            far = images[-1] + leap[left, None] * off[-1]
            ahead = np.where(creeps[:, None], far, _extrapolated(images, off)).clip(0.0)
        goes = (ahead != images[-1]).any(axis=1)
        gained = left[:0]
        if goes.any():
            tried = at(left[goes], ahead[goes])
            count[left[goes]] += 1
            gain = np.where(creeps[goes], 1 + SAME, GAIN)
            good = tried.residual <= gain * last.residual[left[goes]]
            gained = left[goes][good]
            take(gained, Iterates._make(array[good] for array in tried))
            leap[gained] *= np.where(creeps[goes][good], LEAP, 1.0)
        rest = np.setdiff1d(left, gained)
        rest = rest[count[rest] < most]
        if rest.size:
            take(rest, at(rest, last.image[rest]))
            count[rest] += 1
            leap[rest] = LEAP
        kept = [*kept[1 - MEMORY :], (last.s.copy(), last.image.copy())]


def _extrapolated(images: Sequence[Array] | Array, off: Array) -> Array:
    """Where s would be its own value if that depended linearly on it, shape (b, c).

    Parameters
    ----------
    images, off : ndarray, shape (k, b, c)
        Values at the last iterates, and how far they are off.
    """
    changes = np.moveaxis(np.diff(off, axis=0), 0, -1)
    share = np.linalg.pinv(changes, rcond=EXTRAPOLATED) @ off[-1][..., None]
    ways = np.moveaxis(np.diff(images, axis=0), 0, -1)
    return np.asarray(images[-1] - (ways @ share)[..., 0])
