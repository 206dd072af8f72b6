"""Whether a certificate holds, and what is wrong with it in words."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import clipped


@dataclass(frozen=True)
class Verdict:
    """Whether a certificate holds.

    ``verify`` makes it; its constructor checks nothing.

    Parameters
    ----------
    ok : bool
    reason : str
        Why not, in plain words; empty if it holds.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.verify_answer(step, np.zeros(6), []).reason
    'row +d1 of floor(floor, sphere/sphere#0)/0 is violated by the minimiser on the working set'
    """

    ok: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.ok


def wrong_bits(name: str, numbers: Array, right: Array) -> str:
    """What is wrong with numbers that must be right to the last bit; empty if nothing.

    Parameters
    ----------
    name : str
    numbers, right : ndarray, of the same shape (k,)
        What is judged, and what it must be [of one unit].
    """
    numbers = np.array(numbers, dtype=np.float64)
    if numbers.shape != right.shape:
        return f"{name} has shape {numbers.shape}; the step wants {right.shape}"
    wrong = np.flatnonzero(numbers.view(np.int64) != right.view(np.int64))
    if not wrong.size:
        return ""
    at = int(wrong[0])
    return f"{name}[{at}] is {float(numbers[at])!r}; the exact one rounds to {float(right[at])!r}"


def wrong_claim(name: str, claimed: object, right: object) -> str:
    """What is wrong with a claim that must be right to the last bit; empty if nothing.

    Parameters
    ----------
    name : str
    claimed, right : object
        What is said, and what is true; -0.0 is not 0.0.
    """
    signs = {math.copysign(1.0, v) for v in (claimed, right) if isinstance(v, float)}
    if claimed == right and len(signs) < 2:
        return ""
    return f"{name} is claimed to be {clipped(repr(claimed))}; it is {right!r}"
