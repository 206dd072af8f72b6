"""Fixed points of many maps at once."""

import numpy as np

from quasistatic_ref.optional.doctor.fixed_points import Iterates, fixed_points
from quasistatic_ref.optional.fixed_point import Iterate, fixed_point


def iterates(s, image):
    residual = np.abs(image - s).max(axis=1)
    count = len(s)
    return Iterates(
        s, image, residual, residual < 1e-12, np.zeros((count, 0)), np.zeros((count, 0))
    )


def test_iterates_that_creep_leap_ahead():
    """From 0, s -> min(s + 1e-3, 1) needs a thousand iterates, each with the same residual."""
    counts = []

    def at(of, s):
        counts.append(len(of))
        return iterates(s, np.minimum(s + 1e-3, 1.0))

    found = fixed_points(at, np.zeros((3, 2)), 60)
    assert found.own.all()
    np.testing.assert_allclose(found.image, 1.0)
    assert len(counts) < 60


def test_each_map_goes_as_it_would_alone():
    """Of s -> max(M s + c, 0) some have no fixed point; no fewer are found than one at a time."""
    rng = np.random.default_rng(5)
    M = rng.uniform(-0.9, 0.9, (200, 4, 4))
    c = rng.uniform(-1.0, 1.0, (200, 4))

    def at(of, s):
        return iterates(s, np.maximum(np.einsum("bij,bj->bi", M[of], s) + c[of], 0.0))

    together = fixed_points(at, np.zeros((200, 4)), 40)
    assert 100 < together.own.sum() < 200
    found = 0
    for i in range(200):
        alone = fixed_points(lambda of, s, i=i: at(of + i, s), np.zeros((1, 4)), 40)
        assert together.own[i] == alone.own[0]
        np.testing.assert_allclose(together.s[i], alone.s[0], atol=1e-9)

        def one(s, i=i):
            image = np.maximum(M[i] @ s + c[i], 0.0)
            residual = float(np.abs(image - s).max())
            return Iterate(s, image, residual, residual < 1e-12, None)

        scalar, _ = fixed_point(one, np.zeros(4), 40)
        found += scalar.converged
    assert found <= together.own.sum()


def test_a_map_without_a_value_ends_alone():
    def at(of, s):
        every = iterates(s, np.where(s < 0.5, s + 0.1, 0.7))
        lost = (of == 1) & (s[:, 0] > 0.3)
        return every._replace(
            residual=np.where(lost, np.inf, every.residual), own=every.own & ~lost
        )

    assert fixed_points(at, np.zeros((3, 1)), 60).own.tolist() == [True, False, True]
