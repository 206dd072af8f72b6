"""The names of kinks: of closest points that are not unique, and of tangents that switch axes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box
from quasistatic_ref.optional.derivatives.contact.kinks import _not_unique, _switching
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.tolerances import TIED, UNIQUE
from tests.optional.derivatives.contact.test_depth_ties import couple_of

HALF = np.sqrt(0.5)
CUBE = Box((0.05, 0.05, 0.05))
# Both cubes on an edge, one along x and one along y: the edges cross at a right angle.
ON_EDGE = Rotation.from_euler("x", np.pi / 4).as_matrix()
CROSSED = Rotation.from_euler("z", np.pi / 2).as_matrix() @ ON_EDGE


def test_edges_that_cross_have_no_normal_where_they_touch():
    apart = np.array([0.0, 0.0, 0.1 / HALF])
    at = couple_of(CUBE, CUBE, (ON_EDGE, np.zeros(3)), (CROSSED, apart))
    at = at._replace(phi=0.0)
    assert _not_unique(at)[0] == reason.NO_NORMAL
    # Touching is a share of the reach of 0.1 to 0.2 m.
    for phi, kind in ((UNIQUE * 0.05, reason.NO_NORMAL), (UNIQUE, reason.MANY)):
        for sign in (1, -1):
            assert _not_unique(at._replace(phi=sign * phi))[0] == kind


SWITCHES = {
    "x and y are as far, and x comes nearer": ((0.5, 0.5, HALF), (1, 0, -HALF), False, True),
    "x and z are as far from it": ((0.5, HALF, 0.5), (0, -HALF, 1), False, True),
    "it is upright, and the cone has quarters": ((0, 0, 1), (1, 0, 0), True, False),
    "y is farther by TIED and more": ((0.5, 0.5 + 3 * TIED, HALF), (1, 0, -HALF), False, False),
    "y is farther by less than TIED": ((0.5, 0.5 + TIED / 3, HALF), (1, 0, -HALF), False, True),
}
"""Normal, how it changes by one coordinate, whether the cone has quarters; whether it switches."""


@pytest.mark.parametrize("name", SWITCHES)
def test_tangents_switch_where_two_axes_are_as_far_from_the_normal(name):
    n, d_n, quarters, expected = SWITCHES[name]
    ways = np.array(d_n, dtype=float)[None, :, None]
    assert _switching(np.array(n)[None], ways, quarters) == [expected]
