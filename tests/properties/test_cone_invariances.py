"""What turning the tangent basis leaves, and how polygons approach the circle."""

import numpy as np
import pytest

from quasistatic_ref import solve_step
from tests.helpers import changed, error, random_step
from tests.tolerances import ACTIVE_SET

STEPS = [random_step(seed) for seed in range(4)]
EIGHTH = np.pi / 4


def turned(step, angle):
    """The same step, its tangents turned about n."""
    c = np.cos(angle)
    s = np.sin(angle)
    d1 = step.contacts.d1
    d2 = step.contacts.d2
    return step.replace(contacts=changed(step.contacts, d1=c * d1 + s * d2, d2=c * d2 - s * d1))


@pytest.mark.parametrize(
    ("name", "angle"),
    [("facets-8", EIGHTH), ("facets-64", EIGHTH), ("frictionless", 0.3), ("ellipsoid", 1.0)],
)
def test_a_turn_that_maps_a_cone_to_itself_leaves_the_answer(name, angle):
    # Turned tangents are rounded, cosines of the table too: answers differ by conditioning alone.
    for step in STEPS:
        one = step.replace(cone=name)
        expected = solve_step(one, "none").delta_q
        assert error(step, solve_step(turned(one, angle), "none").delta_q, expected) < ACTIVE_SET
