"""In which order NumPy's products of matrices are summed: tried out, since BLAS does not say.

NumPy leaves ``@`` to a BLAS, which has kernels for each kind of processor. The usual kernels
add the products of an entry one after another, from zero, over rising indices; newer processors
round a product and its sum together, older ones apart. Compiled code can do either, and must do the
same as NumPy.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

import numpy as np

from quasistatic_ref.step.arrays import Array

FUSED, APART = "fused", "apart"
"""One rounding for a product and its sum, or one for each."""


def fused(x: float, y: float, total: float) -> float:
    """The sum total + x y [their unit], rounded once."""
    return float(Fraction(x) * Fraction(y) + Fraction(total))


def apart(x: float, y: float, total: float) -> float:
    """The sum total + x y [their unit], the product rounded before it."""
    return total + x * y


ORDERS: dict[str, Callable[[float, float, float], float]] = {FUSED: fused, APART: apart}


@cache
def products() -> str | None:
    """Which of ``ORDERS`` NumPy's products of small matrices have here; None: neither.

    Products of the shapes that a step has, of irrational numbers: an order that is not NumPy's
    differs in a good part of the entries.
    """
    R, places = _numbers(2, 3, 3), _numbers(2, 3, 4)
    at, columns = _numbers(16, 6), _numbers(6, 7)
    pairs = [(R, places), (R.transpose(0, 2, 1), places), (at[None], columns[None])]
    for name, added in ORDERS.items():
        if all(np.array_equal(left @ right, _product(left, right, added)) for left, right in pairs):
            return name
    return None


def _numbers(*shape: int) -> Array:
    """Roots of whole numbers, of both signs."""
    roots: Array = np.sqrt(np.arange(2.0, 2.0 + np.prod(shape)))
    roots[::3] *= -1
    return roots.reshape(shape)


def _product(left: Array, right: Array, added: Callable[[float, float, float], float]) -> Array:
    """The product of stacks of matrices, entry by entry."""
    out = np.zeros((*left.shape[:2], right.shape[2]))
    for i, j, k in np.ndindex(out.shape):
        for x, y in zip(left[i, j].tolist(), right[i, :, k].tolist(), strict=True):
            out[i, j, k] = added(x, y, float(out[i, j, k]))
    return out
