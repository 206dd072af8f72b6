"""Newton's method in the ellipsoid: the interior point's answer, from any start, and sharper."""

import numpy as np
import pytest

from quasistatic_ref import Certificate, solve_step, verify_answer
from quasistatic_ref.lab.made_steps.slider import push, push_step
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure
from tests.closeness import assert_same
from tests.helpers import changed, pinch
from tests.made import repeated
from tests.tolerances import ROUNDING


def planar_push():
    arm = np.array([-0.03, 0.02])
    way = np.array([1.0, 0.0])
    return push_step(push(arm, way, mu_v=0.4, chi=0.03, Pi=0.05, lifted=1.0, sticks=True))


def enclosure_from_clarabel(step):
    """The enclosure that starts from Clarabel's answer, and that answer."""
    answer = solve_step(step, "clarabel", certify="off")
    start = answer.delta_q, answer.lam
    return enclosure(step, start), start


@pytest.mark.parametrize("step", [planar_push(), pinch(grip=5.0, offset=0.2), pinch(grip=5.0)])
def test_any_start_ends_in_the_same_bits(step):
    # A start that is wrong, or of another step, costs time only.
    step = step.replace(cone="ellipsoid")
    found, (delta_q, lam) = enclosure_from_clarabel(step)
    for start in (None, (0 * delta_q, 0 * lam), (-3 * delta_q, lam[::-1].copy())):
        other = enclosure(step, start)
        assert_same(other.delta_q, found.delta_q)
        size = np.abs(found.net).max()  # entries that are zero are what the pair leaves
        np.testing.assert_allclose(other.net, found.net, rtol=ROUNDING, atol=ROUNDING * size)


def test_contacts_stick_by_dependent_rows_while_another_slides():
    # Four soft contacts at one point stick: sixteen rows of rank four. The push is shared by them.
    step = planar_push()
    one, _ = enclosure_from_clarabel(step)
    step = step.replace(contacts=repeated(step.contacts, [0, 1, 1, 1]))
    found, _ = enclosure_from_clarabel(step)
    assert_same(found.delta_q, one.delta_q)
    lam = found.lam.reshape(4, 4)
    assert (lam[1:, 0] > 0).all()
    claims = Certificate("enclosure", error_bound=found.error, gap=found.gap, step=step)
    assert verify_answer(step, found.delta_q, (), found.lam, claims)


def test_contacts_without_friction_and_rows_of_zero_do_not_stop_newton():
    step = planar_push()
    smooth = step.replace(contacts=changed(step.contacts, mu_v=[0.4, 0.0]))
    found, _ = enclosure_from_clarabel(smooth)
    cold = enclosure(smooth)
    assert found.working_set is None
    assert_same(found.delta_q, cold.delta_q)
