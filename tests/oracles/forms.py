"""A quadratic program of float64 numbers without rounding."""

import numpy as np

from quasistatic_ref.exact.program import MatrixProgram, exact_matrix


def exact_form_of(H, g, A, b, bits=None):
    """Min x'Hx / 2 - g'x subject to A x >= b, with the numbers as they are; balls of some bits."""
    column = np.asarray(g, dtype=np.float64)[:, None]
    return MatrixProgram(*map(exact_matrix, (H, column, np.column_stack([A, -b]))), bits=bits)
