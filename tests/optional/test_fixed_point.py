"""A fixed point to which iterates creep."""

import numpy as np

from quasistatic_ref.optional.fixed_point import Iterate, fixed_point


def test_iterates_that_creep_leap_ahead():
    """From 0, s -> min(s + 1e-3, 1) needs a thousand iterates, each with the same residual."""

    def at(s):
        image = np.minimum(s + 1e-3, 1.0)
        residual = float(np.abs(image - s).max())
        return Iterate(s, image, residual, residual < 1e-12, None)

    found, count = fixed_point(at, np.zeros(2), 60, leaps=True)
    assert found.converged
    np.testing.assert_allclose(found.image, 1.0)
    assert count < 60
