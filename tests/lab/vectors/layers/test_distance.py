"""Layer distance: the package and the plain program by closed forms and by exchange."""

import numpy as np
import pytest

from quasistatic_ref.lab.program.distance import distance as program
from quasistatic_ref.lab.vectors.layers.distance import own
from quasistatic_ref.lab.vectors.tables import ORIGIN, at
from tests.closeness import assert_within
from tests.tolerances import CLOSED_FORM

EACH = pytest.mark.parametrize("distance", [own, program])


@EACH
def test_on_the_medial_plane_of_an_ellipsoid_two_sides_are_as_near(distance):
    # x = (0, 1/2, 1) of half-axes 1/4, 1/2, 1 at p = (0, 0.1, 0): t = -1/16 gives
    # x_y = p_y / (1 - 1/4), x_x^2 = 1/16 (1 - 4 x_y^2).
    solid = {"kind": "ellipsoid", "half_axes": [0.25, 0.5, 1.0]}
    point = {"kind": "cloud", "points": [[0.0, 0.0, 0.0]]}
    poses = {"pose_alpha": ORIGIN, "pose_beta": at(0.0, 0.1, 0.0)}
    found = distance({"alpha": solid, "beta": point, **poses})
    y = 0.1 / 0.75
    x = np.sqrt((1 - 4 * y * y) / 16)
    assert_within(np.abs(found["alpha"]), [[x, y, 0]], CLOSED_FORM)
    assert_within(found["phi"], [-np.hypot(x, y - 0.1)], CLOSED_FORM)
