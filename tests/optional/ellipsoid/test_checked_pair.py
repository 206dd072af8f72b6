"""A pair of the ellipsoid's program, scaled, checked and rounded: closed forms of a point mass."""

import numpy as np
import pytest
from flint import arb_mat

from quasistatic_ref import verify
from quasistatic_ref.optional.ellipsoid.enclosure import GAP, RESERVE, checked, checked_pair
from quasistatic_ref.optional.ellipsoid.interior import Pair
from quasistatic_ref.optional.ellipsoid.scaled_blocks import scaled_blocks
from tests.closeness import assert_relative
from tests.helpers import point_on_floor, results_of
from tests.made import StepProgram
from tests.optional.pushed_block import FACE, TIP_RADIUS, pushed_block

M, MU, PHI, H_STEP = 0.3, 0.5, 2e-3, 0.01
"""Mass [kg], friction [-], gap [m] and time step [s] of the point."""
FORCE = np.array([4.0, -1.0, -0.3 * 9.81])
"""Its load [N]."""


STEP = point_on_floor(M, MU, PHI, FORCE, H_STEP).replace(cone="ellipsoid")
FORM = StepProgram(STEP)
AXES = np.stack([STEP.contacts.n[0], STEP.contacts.d1[0], STEP.contacts.d2[0]])


@pytest.mark.parametrize("k", [1, 2, 3])
def test_a_pair_outside_of_its_cone_in_any_coordinate_is_refused(k):
    """The cone is y_0 >= |(y_1, y_2, y_3)|, here with y_0 = 1."""
    frame = scaled_blocks(STEP, FORM)
    for share, inside in ((0.99, True), (-0.99, True), (1.01, False), (-1.01, False)):
        y = arb_mat([[1], *([share if i == k else 0.0] for i in (1, 2, 3))])
        found = checked(frame, Pair(arb_mat(3, 1), y))
        assert (found is not None) == inside


def test_the_gap_of_a_pair_is_the_distance_to_the_optimum_of_its_lagrangian_and_its_work():
    """Of m / 2 h |x - h^2 F / m - h p / m|^2 + lam' s, p being the impulse of the contact."""
    frame = scaled_blocks(STEP, FORM)
    x = np.array([1e-3, 0.0, 5e-3])
    lam = np.array([0.02, -3e-3, 4e-3, 0.0])
    off = x - H_STEP**2 * FORCE / M - H_STEP / M * lam[:3] @ AXES
    s = np.array([PHI, 0.0, 0.0]) + AXES @ x
    expected = M / (2 * H_STEP) * off @ off + lam[:3] @ s
    gap = checked(frame, frame.start(x, lam)).gap / FORM.h
    assert_relative(float(gap), expected)


def test_claims_of_a_push_are_proved_by_the_interior_point():
    # The two pairs may be on opposite sides of the optimum: sqrt(2 RESERVE) is as long as the
    # interior point's own bound twice over, as long as its gap is below RESERVE / 4.
    scenario = pushed_block(-(FACE + TIP_RADIUS), 0.02, cone="ellipsoid")
    for result in results_of(scenario):
        step = result.step
        pair = checked_pair(step)
        size = scaled_blocks(step, StepProgram(step)).size
        assert pair.gap < RESERVE / 4 * size * size
        assert verify(result.solution)
    assert result.solution.certificate.kind == "enclosure"
    assert RESERVE > 4 * GAP
