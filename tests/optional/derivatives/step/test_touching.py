"""Which rows touch and bear load, and the equations that the optimum keeps, in closed form."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.step.optimum_rates import (
    Equations,
)
from quasistatic_ref.optional.derivatives.step.touching import (
    BEARING,
    SHARE,
    TOUCHING,
    bearing,
    touching_rows,
)
from quasistatic_ref.tolerances import FILLED, SPLIT
from tests.helpers import changed, point_on_floor


def test_a_multiplier_is_nothing_compared_with_the_size_of_the_step():
    size = 1e3
    lam = np.array([100.0, 0.01]) * BEARING * size
    assert bearing(np.eye(2), lam, size).tolist() == [True, False]
    assert bearing(np.eye(2), np.array([1.0, BEARING]), 1.0).tolist() == [True, False]


def test_a_row_in_the_span_of_those_that_bear_load_bears_it_too():
    """(1, 0) is 50 times h_1 + h_2: it takes 1/50 of their load at most, which is not nothing."""
    size = 1 / BEARING
    sine = 0.01
    rows = np.array([[sine, 1.0], [sine, -1.0], [1.0, 0.0]])
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    assert bearing(rows, np.array([2.0, 2.0, 0.0]), size).tolist() == [True, True, True]


@pytest.mark.parametrize("off", [0.0, SPLIT / SHARE / 10])
def test_rows_that_face_each_other_bear_load_in_some_optimal_lam(off):
    """Also where another row bears a hundred times the step.

    Where they are off by an angle, a share SHARE of the load misses it by SHARE * off, which is
    below SPLIT.
    """
    size = 1e7
    rows = np.array([[1.0, 0, 0], [0, 1, 0], [0, -1, off], [0, 0, 1]])
    lam = np.array([100.0 * size, 0.0, 0.0, 0.0])
    assert bearing(rows, lam, size).tolist() == [True, True, True, False]


def test_without_a_load_rows_that_face_each_other_bear_all_the_same():
    """For each t, t a_1 + t a_2 = 0: both bear in some optimal lam. The last row does in none."""
    rows = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    assert bearing(rows, np.zeros(3), 0.0).tolist() == [True, True, False]


def answer(step, lam):
    """An answer that stands still."""
    return SimpleNamespace(step=step, delta_q=np.zeros(3), lam=lam)


@pytest.mark.parametrize("unit", [1.0, 2.0**100, 2.0**-100])
def test_what_touches_and_bears_does_not_depend_on_the_unit_of_mass(unit):
    """A point at the limit of friction: the row against the push bears all load, and all touch.

    Of the load, another row is left with a share of BEARING / 1000, by rounding.
    """
    W = 3.0 * unit
    mu = 0.5
    h = 0.01
    step = point_on_floor(0.3 * unit, mu, force=(mu * W, 0.0, -W), h=h)
    lam = h * W * np.array([BEARING / 1000, 0.0, 1.0, 0.0])  # of +d1, +d2, -d1, -d2
    found = touching_rows(answer(step, lam), np.zeros(1))
    assert found.strict.tolist() == [[0, 2]]
    assert found.idle.tolist() == [[0, 0], [0, 1], [0, 3]]
    assert Equations(found).s.tolist() == pytest.approx([1.0])


def test_rows_touch_within_the_rounding_of_their_place_or_under_load():
    gap = TOUCHING / 2
    step = point_on_floor(phi=gap, force=(0.0, 0.0, -1.0))
    still = answer(step, np.zeros(4))
    assert len(touching_rows(still, np.ones(1)).idle) == 4
    assert not touching_rows(still, np.zeros(1)).contacts
    pressed = answer(step, np.array([0.0, 1.0, 0.0, 0.0]))
    assert touching_rows(pressed, np.zeros(1)).strict.tolist() == [[0, 1]]


@pytest.mark.parametrize(("phi", "away"), [(1e-3, 4), (FILLED, 0)])
def test_where_nothing_moves_a_contact_that_is_away_does_not_touch(phi, away):
    """One of its contacts moves with no coordinate: its rows are zero.

    Of the contact that stands for nothing no row is away.
    """
    step = point_on_floor(phi=phi)
    for J in (step.contacts.J, 0 * step.contacts.J):
        moved = step.replace(contacts=changed(step.contacts, J=J))
        found = touching_rows(answer(moved, np.zeros(4)), np.ones(1))
        assert not found.contacts
        assert found.slack.tolist() == [phi] * away
