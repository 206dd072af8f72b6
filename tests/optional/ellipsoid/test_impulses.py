"""Impulses in the ellipsoid: inside of their cones without rounding, and raised into them."""

import numpy as np
import pytest

from quasistatic_ref import Extra
from quasistatic_ref.optional.ellipsoid.impulses import outside_of_cones, raised
from quasistatic_ref.optional.gap import fractions
from tests.made import contacts_of, free_step


def step_of():
    """A body with two contacts of six rows, and a row of the user's own."""
    contacts = contacts_of(0.0, [np.eye(3)] * 2, [np.eye(4, 6)] * 2, (0.5, 0.25), (0.125, 0.0), 6)
    step = free_step(np.eye(6), np.zeros(6), contacts, 0.01).replace(cone="ellipsoid")
    return step.replace(extra=Extra(("own",), np.eye(6)[:1], np.zeros(1)))


# ||(v / mu)||: of (3/10, 2/5) / (1/2) it is 1; of (1/4, 0, 1/8) / (1/2, 1/2, 1/8) sqrt(5)/2.
GOOD = [[1.5, 0.3, 0.4, 0.125], [4.0, 0.25, 0.75, 0.0]]


@pytest.mark.parametrize(
    ("place", "value", "name"),
    [
        ((0, 0), 1.5, ""),
        ((0, 0), 1.4, "c0"),  # sqrt(1 + 1) are needed
        ((0, 1), -0.36, ""),  # 0.72^2 + 0.8^2 + 1 < 1.5^2
        ((0, 1), -0.4, "c0"),  # 2 0.8^2 + 1 > 1.5^2
        ((1, 0), 3.1, "c1"),  # sqrt(1 + 9)
        ((1, 3), 1e-300, "c1"),  # where there is no friction about n
        ((1, 0), -4.0, "c1"),
        ((2, 0), -1e-300, "own"),
    ],
)
def test_the_contact_or_row_whose_impulse_is_outside_is_named(place, value, name):
    lam = np.array([*GOOD[0], *GOOD[1], 1.0])
    lam[4 * place[0] + place[1]] = value
    assert outside_of_cones(step_of(), fractions(lam)) == name


def test_only_normal_parts_are_raised_and_only_by_rounding():
    step = step_of()
    lam = np.array([0.7, 0.3, 0.4, 0.125, 1.0, 0.25, 0.75, 0.0, 1.0])
    up = raised(step, lam)
    tangential = np.ones(9, dtype=bool)
    tangential[[0, 4]] = False
    assert (up[tangential] == lam[tangential]).all()
    assert outside_of_cones(step, fractions(up)) == ""
    for i, name in ((0, "c0"), (4, "c1")):
        lower = up.copy()
        lower[i] = up[i] * (1 - 4 * np.finfo(float).eps)
        assert outside_of_cones(step, fractions(lower)) == name


def test_impulses_inside_of_their_cone_are_left():
    lam = np.array([*GOOD[0], *GOOD[1], 1.0])
    assert (raised(step_of(), lam) == lam).all()
    edge = np.array([1.0, 0.5, 0.0, 0.0, 1.0, 0.0, -0.25, 0.0, 1.0])  # exactly at the boundary
    assert (raised(step_of(), edge) == edge).all()
    assert outside_of_cones(step_of(), fractions(edge)) == ""
