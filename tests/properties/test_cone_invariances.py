"""What turning the tangent basis leaves, and how polygons approach the circle."""

import numpy as np
import pytest

from quasistatic_ref import solve_step, standard_form
from tests.closeness import assert_within
from tests.helpers import changed, error, point_on_floor, random_step
from tests.tolerances import ACTIVE_SET

STEPS = [random_step(np.random.default_rng(seed), rows=(6, 4, 6)) for seed in range(4)]
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


def optimal_value(step, delta_q):
    """The objective of (13)."""
    form = standard_form(step)
    return 0.5 * delta_q @ form.H @ delta_q - form.g @ delta_q


def test_facets_converge_as_K_to_the_minus_2_and_motions_as_1_over_K():
    # A point pushed across the floor. Friction of a K-gon in a direction is between mu cos(pi/K)
    # and mu, so the optimal value is off by O(1/K^2). By strong convexity the motion is off by the
    # root of that at most, and is: a facet turns the direction of slip by up to pi/K.
    angle = 0.2
    force = 4.0 * np.array([np.cos(angle), np.sin(angle)])
    values = []
    motions = []
    for K in (8, 32, 128):
        value = []
        motion = []
        for turn in np.linspace(0.0, 2 * np.pi / K, 9)[:-1]:
            step = turned(point_on_floor(force=(*force, -3.0)), turn)
            circle = solve_step(step.replace(cone="ellipsoid"), "none").delta_q
            facets = solve_step(step.replace(cone=f"facets-{K}"), "none").delta_q
            value.append(abs(optimal_value(step, facets) / optimal_value(step, circle) - 1))
            motion.append(error(step, facets, circle))
        values.append(max(value))
        motions.append(max(motion))
    doublings = np.log2(128 / 8)
    assert_within(np.log2(values[0] / values[-1]) / doublings, 2.0, 0.2)
    assert_within(np.log2(motions[0] / motions[-1]) / doublings, 1.0, 0.2)
