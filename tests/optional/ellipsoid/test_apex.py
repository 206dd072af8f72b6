"""The ellipsoid at its apex: which rows hold a body that sticks, and what is refused."""

import numpy as np
import pytest

from quasistatic_ref.optional.ellipsoid.apex import apex
from quasistatic_ref.optional.ellipsoid.cone import ELLIPSOID_CONE
from tests.made import StepProgram, contacts_of, free_step


def body_on_one_place(force, mu_v, mu_omega=0.0, h=0.5, lever=1.0):
    """A body that moves along x, y, z and turns about z, on contacts that are all in one place."""
    frames, J = ([of] * len(mu_v) for of in (np.eye(3), lever * np.eye(4)))
    at = contacts_of(0.0, frames, J, mu_v, mu_omega, rows=6)
    return free_step(np.eye(4), [*force, 0.0], at, h).replace(cone="ellipsoid")


@pytest.mark.parametrize(
    ("mu_v", "mu_omega", "rows"),
    [(0.5, 0.1, (0, 1, 2, 3)), (0.5, 0.0, (0, 1, 2)), (0.0, 0.1, (0, 3)), (0.0, 0.0, (0,))],
)
def test_directions_without_friction_hold_nothing(mu_v, mu_omega, rows):
    step = body_on_one_place((0.0, 0.0, -2.0), [mu_v], mu_omega)
    assert apex(step, StepProgram(step), np.array([1.0, 0, 0, 0])).rows == rows
    assert apex(step, StepProgram(step), np.zeros(4)).rows == ()


def test_contacts_in_one_place_share_a_load_as_their_friction_allows():
    """J = 3 and h = 1/2: h f = 3 (lam_0 + lam_1), so f = (3.3, 0, -12) needs (-0.55, 2) in all.

    Of that the first contact can hold |t| <= 0.1 n and the second |t| <= n.
    """
    step = body_on_one_place((3.3, 0.0, -12.0), [0.1, 1.0], lever=3.0)
    form = StepProgram(step)
    lam = np.array([1.0, -0.05, 0.0, 0.0, 1.0, -0.5, 0.0, 0.0])
    answer = apex(step, form, lam)
    assert (answer.rows, answer.refutation) == ((0, 1, 2), "")
    swapped = lam[[0, 5, 2, 3, 4, 1, 6, 7]]
    assert apex(step, form, swapped).refutation == "the force at c0 is outside of its cone"


@pytest.mark.parametrize("i", [4, 5, 7])
def test_impulses_that_do_not_balance_are_outside_of_their_cone(i):
    """A second contact without load of its own: a force there has no normal, or no coefficient."""
    step = body_on_one_place((0.0, 0.0, -2.0), [0.5, 0.5])
    lam = np.zeros(8)
    lam[0] = 1.0
    assert apex(step, StepProgram(step), lam).refutation == ""
    lam[i] = -1e-300
    assert apex(step, StepProgram(step), lam).refutation == "the force at c1 is outside of its cone"


@pytest.mark.parametrize(("short", "right"), [(1e-12, True), (1e-5, False)])
def test_impulses_without_a_claimed_gap_are_in_their_cone_but_for_rounding(short, right):
    """At the limit of friction, |t| = mu n; n = 2^-14 N s is said to be a little less."""
    n = 2.0**-14
    step = body_on_one_place((n, 0.0, -2 * n), [0.5], h=1.0)  # h f = (n, 0, -2 n)
    lam = np.array([2 * n * (1 - short), -n, 0.0, 0.0])
    verdict = ELLIPSOID_CONE.verdict(step, np.zeros(4), ((0, 0), (0, 1), (0, 2)), lam, None)
    assert bool(verdict) == right
    assert right or "outside of its cone" in verdict.reason
