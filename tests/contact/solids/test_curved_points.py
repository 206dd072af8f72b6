"""Signed distances of points to a cone and to an ellipsoid, at every feature of theirs."""

import numpy as np
import pytest

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.shapes.placed_shape import Cone, Ellipsoid
from tests.tolerances import CLOSED_FORM, EXACT, ROUNDING

# In the half-plane (r, z) the side of this cone leads from the rim (0.3, -0.2) to the tip (0, 0.2):
# a triangle of sides 3, 4 and 5, so that the side's normal is (4, 3) / 5.
CONE = Cone(0.3, 0.2)
BY_CONE = {
    "off the side": ((0.15, 0.0), 0.1, (0.8, 0.6)),
    "within the side": ((0.15, 0.0), -0.02, (0.8, 0.6)),
    "off the tip": ((0.0, 0.2), 0.1, (0.6, 0.8)),
    "above the tip": ((0.0, 0.2), 0.1, (0.0, 1.0)),
    "off the rim": ((0.3, -0.2), 0.1, (0.6, -0.8)),
    "below the middle of the base": ((0.1, -0.2), 0.7, (0.0, -1.0)),
    "below the base, next to the rim": ((0.2, -0.2), 0.2, (0.0, -1.0)),
    "within the base": ((0.1, -0.2), -0.01, (0.0, -1.0)),
}
"""The nearest point of the cone (r, z), the signed distance along the normal, and the normal."""


@pytest.mark.parametrize(("foot", "distance", "normal"), BY_CONE.values(), ids=BY_CONE)
def test_a_point_put_off_a_feature_of_a_cone_has_that_distance(foot, distance, normal) -> None:
    r, z = np.add(foot, np.multiply(distance, normal))
    for x, y in ((1.0, 0.0), (-0.6, 0.8)):  # half-planes about the axis
        phi, n = signed_distance(CONE, np.array([[r * x, r * y, z]]))
        np.testing.assert_allclose(phi, [distance], rtol=EXACT, atol=CLOSED_FORM)
        turned = [normal[0] * x, normal[0] * y, normal[1]]
        if r > 0:
            np.testing.assert_allclose(n, [turned], rtol=EXACT, atol=CLOSED_FORM)
        else:
            np.testing.assert_allclose(n[0, 2], normal[1], rtol=EXACT, atol=CLOSED_FORM)


def test_the_normal_at_a_tip_is_one_of_the_tip_whatever_is_rounded(rng) -> None:
    """Along all generators from the tip, (radius, -2 half_length), n may not point into the cone.

    So n_r radius <= 2 half_length n_z; of the side's normal the two are equal.
    """
    for radius, half_length in rng.uniform(0.01, 1.0, size=(500, 2)):
        phi, n = signed_distance(Cone(radius, half_length), np.array([[0.0, 0.0, half_length]]))
        np.testing.assert_allclose(phi, [0.0], rtol=EXACT, atol=CLOSED_FORM)
        np.testing.assert_allclose(np.sum(n * n), 1.0, rtol=ROUNDING)
        n_r = np.hypot(n[0, 0], n[0, 1])
        assert n_r * radius <= 2 * half_length * n[0, 2] + CLOSED_FORM


@pytest.mark.parametrize("z", [0.0, -0.0])
@pytest.mark.parametrize("x", [0.0, 0.1, -0.1])
def test_half_way_through_an_ellipsoid_the_upper_side_is_the_nearest(x, z) -> None:
    # Near the middle of the plane z = 0 the nearest points are two, one above and one below. Of
    # (x, 0, 0) they are at x' = a^2 x / (a^2 - c^2): there the gradient (x' / a^2, 0, z' / c^2) is
    # parallel to the way (x' - x, 0, z').
    a, b, c = 0.3, 0.2, 0.1
    foot_x = a**2 * x / (a**2 - c**2)
    way = np.array([foot_x - x, 0.0, c * np.sqrt(1 - (foot_x / a) ** 2)])
    phi, n = signed_distance(Ellipsoid(np.array([a, b, c])), np.array([[x, 0.0, z]]))
    np.testing.assert_allclose(phi, [-np.sqrt(way @ way)], rtol=EXACT, atol=CLOSED_FORM)
    np.testing.assert_allclose(n, [way / np.sqrt(way @ way)], rtol=EXACT, atol=CLOSED_FORM)


def test_just_off_a_rim_the_normal_leads_away_from_it() -> None:
    # A ten thousandth of a billionth of the size away: the direction has its first four digits.
    cone, off = Cone(0.03, 0.02), 1e-12
    phi, n = signed_distance(cone, np.array([[0.03 + off, 0.0, -0.02]]))
    np.testing.assert_allclose(phi, [off], rtol=1e-4)
    np.testing.assert_allclose(n, [[1.0, 0.0, 0.0]], atol=1e-4)
