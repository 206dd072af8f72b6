"""How large a step is: source/natural.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.library import addresses, function
from quasistatic_ref.solve.by_group import NaturalHessian
from quasistatic_ref.solve.units import Sizes


def step_sizes(_: None) -> Callable[[Array, Array, Array, NaturalHessian], Sizes | None]:
    """``step_sizes`` in C; it declines numbers that are not finite.

    It returns sizes, shape (groups,), or None.
    """
    compiled = function("step_sizes")

    def answer(A: Array, b: Array, g: Array, H: NaturalHessian) -> Sizes | None:
        written = np.empty(4)
        sizes = np.array([*A.shape, *H.inverse.shape])
        read = sizes, A, H.own_unit, b, g, H.inverse, H.column
        answered = compiled(*addresses(read, (np.empty(len(b)), written)))
        return Sizes(*written.tolist()) if answered else None

    return answer


def trials_of_step_sizes() -> list[tuple[None, tuple[Array, Array, Array, NaturalHessian]]]:
    """An even and an odd number of rows, of which some are zero.

    Arrays of shapes (m, w), (m,), (n_v,).
    """
    numbers = np.sin(np.arange(1.0, 94.0))
    A, unit, b = numbers[:30].reshape(10, 3), numbers[30:60].reshape(10, 3), numbers[60:70]
    A = A * (numbers[60:70] < 0.9)[:, None]
    inverse, column = numbers[70:78].reshape(4, 2), np.array([[0, 3], [0, 3], [1, 4], [2, 4]])
    H = NaturalHessian(numbers[78:82], unit, [], inverse, column)
    g = numbers[82:86]
    return [(None, (A, b, g, H)), (None, (A[:7], -np.abs(b[:7]), g, H._replace(own_unit=unit[:7])))]
