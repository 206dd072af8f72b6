r"""The one definition of error, and correct digits of any answer.

.. math:: \mathrm{error} = \frac{\|x - x^*\|_H}{\|H^{-1} g\|_H}, \qquad
          \mathrm{digits} = -\log_{10} \mathrm{error} \text{, clipped to } 0 \ldots 16,

with ||v||_H^2 = v'Hv; if g = 0, digits are 16 where x = x* and 0 elsewhere. Net impulses and
slacks are measured as the displacements that they stand for, so that the three can be compared:

- net impulse p = A'lam by the displacement H^-1 p that it causes:
  ||p - p*||_{H^-1} / ||H^-1 g||_H, with ||p||_{H^-1} = ||H^-1 p||_H;
- slack of row i by the shortest displacement that changes it so much:
  max_i |a_i'(x - x*)| / ||a_i||_{H^-1} / ||H^-1 g||_H, never more than the error of x.
"""

import numpy as np

MOST = 16.0
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
    return min(MOST, float(-np.log10(error))) if error > 0 else MOST


def relative_digits(off: float, unconstrained: float) -> float:
    """Correct digits, 0 to 16 [-], of what is `off` where ||H^-1 g||_H is `unconstrained`."""
    if unconstrained == 0:
        return MOST if off == 0 else 0.0
    return digits_of_error(off / unconstrained)
