"""Tangents that switch axis: a kink only where the step feels it."""

import numpy as np
import pytest

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.step.reason import TANGENTS
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Sphere
from quasistatic_ref.simulate.simulator import Simulator
from tests.oracles.differences import after, rate
from tests.tolerances import DIFFERENCE_OF_STEPS

NONE = np.zeros(0)


@pytest.mark.parametrize("side", [0.0, 2.6, 2.75, 6.0])
def test_tangents_that_switch_are_named_only_where_the_step_feels_it(side):
    # A point on a ball where the axes x and y are as far from the normal, (1, 1, 2) / sqrt(6). The
    # cosine between both d1 is -1/5, so that a force along the one is inside of the other's pyramid
    # up to mu N / (1/5 + sqrt(24)/5); inside of its own alone up to mu N, and beyond it slides.
    # N is the push of 6 and what lifts 0.3 kg by 1e-4 in 0.01 s, 0.3.
    up = np.array([1.0, 1.0, 2.0]) / np.sqrt(6)
    along = np.array([5.0, -1.0, -2.0]) / np.sqrt(30)
    limit = 0.5 * 6.3 / (0.2 + np.sqrt(0.96))
    system = System([Body.of_shape("body", Sphere(0.05), 0.3)])
    here = np.eye(3), np.zeros(3)
    point = PlacedShape("body", system.link("body"), *here, PointCloud(np.zeros((1, 3))))
    pair = ContactPair("c0", PlacedShape("ball", 0, *here, Sphere(0.05)), point, 0.5, 0.01, 6, 1)
    simulator = Simulator(system, [pair], h=0.01, K_q=np.zeros((0, 0)))
    q = np.concatenate([0.0499 * up, [0.0, 0.0, 0.0, 1.0]])
    weightless = np.array([0.0, 0.0, 0.3 * 9.81])
    force = np.concatenate([weightless - 6 * up + side * along, np.zeros(3)])
    found = derivatives(simulator, q, NONE, force)
    assert {why.kind for why in found.reasons} == (set() if side < limit else {TANGENTS})
    if side < limit:
        move = system.integrate
        slopes = [
            rate(lambda t, e=e: after(simulator, found.result.q, move(q, t * e), NONE, force))
            for e in np.eye(6)
        ]
        assert np.abs(found.dq_dq - np.column_stack(slopes)).max() <= DIFFERENCE_OF_STEPS
