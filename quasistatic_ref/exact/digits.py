"""Correct digits of an answer."""

import numpy as np

MOST_DIGITS = 16.0
"""Digits of a float64: more cannot be known."""


def digits_of_error(error: float) -> float:
    """-log10 of a relative error [-], clipped to 0 .. 16; 0 for NaN.

    Examples
    --------
    >>> digits_of_error(1e-9), digits_of_error(0.0), digits_of_error(3.0)
    (9.0, 16.0, 0.0)
    """
    if not error < 1:
        return 0.0
    return min(MOST_DIGITS, float(-np.log10(error))) if error > 0 else MOST_DIGITS
