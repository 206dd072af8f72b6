"""Short proofs that rows contradict each other: parallel rows, or one row and bounds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from flint import fmpq

from quasistatic_ref.exact.qp.block import Block

CLOSE = 1e-6
"""What a row may miss over the size of its terms to be looked at in fractions [-]."""


def short_proof(block: Block) -> dict[int, fmpq] | None:
    """Factors of two parallel rows, or of a row and bounds, that contradict each other."""
    for factors in _suspects(block):
        left, limit = block.combined(factors)
        if limit < 0 and not left:
            return factors
    return None


def _suspects(block: Block) -> Iterator[dict[int, fmpq]]:
    """Factors of few rows that float64 does not show to be consistent."""
    a, c, e = block.a, block.c, block.equations
    lowest: dict[bytes, tuple[float, int]] = {}
    highest: dict[bytes, tuple[float, int]] = {}
    first = np.take_along_axis(a, (a != 0).argmax(axis=1)[:, None], axis=1)[:, 0]
    for i in np.flatnonzero(first).tolist():
        key = ((a[i] / first[i]).round(12) + 0.0).tobytes()
        at = -c[i] / first[i]
        if i < e or first[i] > 0:
            lowest[key] = max(lowest.get(key, (-np.inf, i)), (at, i))
        if i < e or first[i] < 0:
            highest[key] = min(highest.get(key, (np.inf, i)), (at, i))
    for key in lowest.keys() & highest.keys():
        (least, i), (most, k) = lowest[key], highest[key]
        if least > most - CLOSE * abs(most):
            one, other = (abs(_entry(block, t)) for t in (i, k))
            way = 1 if first[i] > 0 else -1
            yield {i: way * other, k: way * one if first[k] < 0 else -way * one}
    units = [row.tobytes() for row in np.eye(block.n)]
    low, of_low = np.array([lowest.get(key, (-np.inf, 0)) for key in units]).T
    high, of_high = np.array([highest.get(key, (np.inf, 0)) for key in units]).T
    with np.errstate(invalid="ignore"):
        for way in (1, -1):
            limit = np.where(way * a > 0, high, low)
            terms = np.where(a != 0, way * a * limit, 0.0)
            size = np.abs(terms).sum(axis=1) + np.abs(c)
            short = way * c + terms.sum(axis=1) < CLOSE * size
            for i in np.flatnonzero(short[: None if way > 0 else e]).tolist():
                entries, _, unit = block.row(i)
                factors = {i: fmpq(way)}
                for j, v in entries.items():
                    k = int((of_high if way * v > 0 else of_low)[j])
                    bound = block.row(k)
                    share = -way * v / unit * bound.entries.get(j, 0) * bound.unit
                    factors[k] = factors.get(k, fmpq(0)) + share
                yield factors


def _entry(block: Block, i: int) -> fmpq:
    """The first entry of a row, in fractions."""
    entries, _, unit = block.row(i)
    return entries[min(entries)] / unit
