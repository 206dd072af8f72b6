"""Every tolerance of the tests, with its reason."""

from typing import Final

ROUNDING: Final = 1e-12
"""The same finite sum of at most some hundred terms of size one, added up in another order."""

DIFFERENCE_STEP: Final = 1e-5
"""Step of central differences [m or rad]: near the cube root of 2.2e-16, where truncation
(step^2 = 1e-10) and cancellation (2.2e-16 / step = 2e-11) are both small."""

DIFFERENCE: Final = 1e-8
"""Jacobians against central differences with that step: truncation is at most step^2 / 6 times a
third derivative, below 100 for chains of a metre, so 2e-9; a wrong column is off by 0.1 or more."""

FILE_FLOAT32: Final = 1e-7
"""A coordinate of size one that travelled through float32: half its unit of 1.2e-7."""
