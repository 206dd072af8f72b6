"""Closest points that slide along a common straight line: where derivatives exist all the same."""

import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.contact.closest_point_rates import closest_point_rates
from quasistatic_ref.optional.derivatives.contact.features import Feature
from tests.tolerances import ROUNDING

X, Y, N = np.eye(3)
ACROSS = np.stack([X, Y])
PHI = 0.1
DIAGONAL = (X + Y) / np.sqrt(2)
EDGE, FACE = (Feature(free=free) for free in (DIAGONAL[None], ACROSS))


def found(features, v, omega, turned=None):
    """Of two bodies at the origin and at PHI N that move by v and turn by omega, one coordinate."""
    R = np.eye(3) if turned is None else turned
    both = [f.turned(R) for f in features]
    own = (np.array(v) @ R.T)[:, None, :, None]
    turn = (np.array(omega) @ R.T)[:, None, :, None]
    phi = np.array([PHI])
    size = np.array([1.0])
    return closest_point_rates(phi, (R @ N)[None], both, own, turn, size)


@pytest.mark.parametrize("features", [(EDGE, FACE), (FACE, EDGE)])
def test_an_edge_on_a_face_may_turn_about_itself_and_about_nothing_else(features):
    turned = [DIAGONAL if f is FACE else 0 * X for f in features]
    rates = found(features, (0 * X, 0 * X), turned)
    assert rates.unique[0]
    # The normal is the face's: dn = DIAGONAL x n.
    np.testing.assert_allclose(rates.n[0, :, 0], np.cross(DIAGONAL, N), rtol=0, atol=ROUNDING)
    for way in (np.cross(DIAGONAL, N), N, X):
        other = [way if f is FACE else 0 * X for f in features]
        assert not found(features, (0 * X, 0 * X), other).unique[0]
        # Both bodies turn as one about the first point.
        as_one = found(features, (0 * X, PHI * np.cross(way, N)), (way, way))
        assert as_one.unique[0]
        np.testing.assert_allclose(as_one.n[0, :, 0], np.cross(way, N), rtol=0, atol=ROUNDING)


def test_each_of_several_pairs_slides_along_its_own_line():
    """Of a face on an edge along y, and an edge along x on a face: it alone turns, about x."""
    features = [FACE, Feature(free=X[None]), Feature(free=Y[None]), FACE]
    omega = np.zeros((2, 2, 3, 1))
    omega[:, 1, :, 0] = X, 0 * X
    n = np.array([N, N])
    rates = closest_point_rates(
        np.full(2, PHI), n, features, np.zeros((2, 2, 3, 1)), omega, np.ones(2)
    )
    assert rates.unique.all()
    np.testing.assert_allclose(rates.n, 0.0, rtol=0, atol=ROUNDING)  # the faces do not turn
