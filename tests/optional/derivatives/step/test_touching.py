"""Which rows touch and bear load, and the equations that the optimum keeps, in closed form."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.step.optimum_rates import (
    DataRates,
    Equations,
    _complementary,
)
from quasistatic_ref.optional.derivatives.step.touching import Touching, bearing, touching_rows
from quasistatic_ref.tolerances import BEARING, CONSISTENT, TOUCHING
from tests.helpers import changed, point_on_floor


def test_a_multiplier_is_nothing_compared_with_the_size_of_the_step():
    size = 1e3
    lam = np.array([100.0, 0.01]) * BEARING * size
    assert bearing(np.eye(2), lam, size).tolist() == [True, False]
    assert bearing(np.eye(2), np.array([1.0, BEARING]), 1.0).tolist() == [True, False]


def test_a_row_in_the_span_of_those_that_bear_load_bears_it_too():
    """(1, 0) is 50 times h_1 + h_2: it takes 1/50 of their load at most, which is not nothing."""
    size, sine = 1 / BEARING, 0.01
    rows = np.array([[sine, 1.0], [sine, -1.0], [1.0, 0.0]])
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    assert bearing(rows, np.array([2.0, 2.0, 0.0]), size).tolist() == [True, True, True]


def test_rows_that_face_each_other_bear_load_in_some_optimal_lam():
    """Also where another row bears a hundred times the step."""
    size = 1e7
    rows = np.array([[1.0, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]])
    lam = np.array([100.0 * size, 0.0, 0.0, 0.0])
    assert bearing(rows, lam, size).tolist() == [True, True, True, False]


def answer(step, lam):
    """An answer that stands still."""
    return SimpleNamespace(step=step, delta_q=np.zeros(3), lam=lam)


@pytest.mark.parametrize("unit", [1.0, 2.0**100, 2.0**-100])
def test_what_touches_and_bears_does_not_depend_on_the_unit_of_mass(unit):
    """A point at the limit of friction: the row against the push bears all load, and all touch.

    Of the load, another row is left with a share of BEARING / 1000, by rounding.
    """
    W, mu, h = 3.0 * unit, 0.5, 0.01
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


def test_where_nothing_moves_a_contact_that_is_away_does_not_touch():
    """One of its contacts moves with no coordinate: its rows are zero."""
    step = point_on_floor(phi=1e-3)
    for J in (step.contacts.J, 0 * step.contacts.J):
        moved = step.replace(contacts=changed(step.contacts, J=J))
        found = touching_rows(answer(moved, np.zeros(4)), np.ones(1))
        assert not found.contacts


def walls(normals, strict, idle):
    """Contacts without friction of a body with H = I, along `normals`."""
    n = len(normals[0])
    generators = np.zeros((len(normals), 4, n))
    generators[:, 0] = normals
    table = np.array([[1.0, 0, 0, 0]])
    rows = [np.array([[j, 0] for j in some], dtype=np.int64).reshape(-1, 2)
            for some in (strict, idle)]  # fmt: skip
    return Touching(np.eye(n), generators, table, *rows, np.zeros((len(normals), 4)))


def rates(normals, load=None, motion=None, terms=0.0, turns=None):
    """One parameter: its load, the motion along each normal, and how the normals turn."""
    n_c, n = np.shape(normals)
    moved = np.zeros((n_c, 4, 1))
    moved[:, 0, 0] = 0.0 if motion is None else motion
    turned = np.zeros((n_c, n)) if turns is None else np.array(turns)
    g = np.zeros((n, 1)) if load is None else np.array(load)[:, None]
    return DataRates(g, moved, np.array([terms]), lambda y: (y[:, 0] @ turned)[:, None])


def test_growth_presses_rows_opens_others_and_leaves_the_rest():
    """The load is along (1, 0, -1), and the rows are y, z, x, -z and y >= 0, of any length.

    z >= 0 bears load; with -z >= 0 it keeps z, so that this one bears load in some optimal lam.
    x >= 0 opens. y >= 0, which stands twice, does neither, and stays idle.
    """
    big, small = 2.0**38, 2.0**-38
    normals = [[0, small, 0], [0, 0, big], [30, 0, 0], [0, 0, -3], [0, 3 * small, 0]]
    touching = walls(normals, [], range(5))
    found = Equations(touching).beyond(rates(normals, load=[1.0, 0.0, -1.0]))
    assert found.strict[:, 0].tolist() == [1, 3]
    assert found.idle[:, 0].tolist() == [0, 4]
    alone = walls(normals[:3], [], range(3))
    found = Equations(alone).beyond(rates(normals[:3], load=[1.0, 0.0, -1.0]))
    assert (found.strict[:, 0].tolist(), found.idle[:, 0].tolist()) == ([1], [0])


def test_a_row_opens_by_more_than_the_rounding_of_what_it_is_a_sum_of():
    """x_1 follows the first wall, which moves by 0.1; the second moves with it, or stays."""
    normals = [[1.0, 0.0], [-3.0, 0.0]]
    touching = walls(normals, [0], [1])
    for motion, opens in (([0.1, -0.3], False), ([0.1, -0.2], True), ([0.0, 0.0], False)):
        found = Equations(touching).rates(rates(normals, motion=motion))
        assert found.opens.ravel().tolist() == [opens]


def test_walls_that_are_one_contradict_each_other_if_they_move_apart():
    """A row and three times it: the motions have to be as 1 to 3, and the turns as well."""
    normals = [[0.0, 1e-3], [0.0, 3e-3]]
    equations = Equations(walls(normals, [0, 1], []))
    turns = [[1.0, 0.0], [3.0, 0.0]]
    rounded = [1.0, 3.0 + CONSISTENT / 10]
    for data, count in (
        (rates(normals, motion=[1.0, 3.0], turns=turns), 0),
        (rates(normals, motion=[1.0, 2.0], turns=turns), 1),
        (rates(normals, motion=[1.0, 3.0], turns=[[1.0, 0.0], [1.0, 0.0]]), 1),
        (rates(normals, motion=[0.0, CONSISTENT / 10], terms=1.0), 0),
        (rates(normals, motion=rounded), 0),
        (rates(normals, turns=[[1e-4 * CONSISTENT, 1.0], [0.0, 0.0]]), 0),
    ):
        found = equations.rates(data).contradicts
        assert len(found) == count
        assert all(contacts == {0, 1} for contacts, _ in found)


def test_pushes_are_zero_where_none_is_needed_or_none_moves_anything():
    """Of slack + rows rows'p >= 0 with p >= 0: -1 + 2 * 2 p = 0 at p = 1/4."""
    assert _complementary(np.zeros((1, 1)), np.array([-1.0])).tolist() == [0.0]
    assert _complementary(np.array([[2.0]]), np.array([-1.0])) == pytest.approx([0.25])
    assert _complementary(np.array([[2.0]]), np.array([1.0])).tolist() == [0.0]
