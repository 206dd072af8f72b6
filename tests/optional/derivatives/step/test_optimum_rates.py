"""How the optimum moves with the data of a step: closed forms, and random steps."""

from dataclasses import replace

import numpy as np

from quasistatic_ref.optional.derivatives.step.optimum_rates import (
    DataRates,
    Equations,
)
from quasistatic_ref.optional.derivatives.step.touching import Touching
from quasistatic_ref.tolerances import CONSISTENT
from tests.closeness import assert_relative
from tests.tolerances import ROUNDING


def walls(normals, strict, idle):
    """Contacts without friction of a body with H = I, along `normals`."""
    n = len(normals[0])
    generators = np.zeros((len(normals), 4, n))
    generators[:, 0] = normals
    table = np.array([[1.0, 0, 0, 0]])
    rows = [np.array([[j, 0] for j in some], dtype=np.int64).reshape(-1, 2)
            for some in (strict, idle)]  # fmt: skip
    impulses = np.zeros((len(normals), 1))
    none = np.zeros(0)
    return Touching(np.eye(n), generators, table, *rows, impulses, rows[0][:0], none)


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
    big = 2.0**38
    small = 2.0**-38
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
    for motion, terms, opens in (
        ([0.1, -0.3], 0.0, False),
        ([0.1, -0.2], 0.0, True),
        ([0.0, 0.0], 0.0, False),
        ([0.0, CONSISTENT / 10], 1.0, False),
    ):
        found = Equations(touching).rates(rates(normals, motion=motion, terms=terms))
        assert found.opens.ravel().tolist() == [opens]


def test_a_wall_exerts_what_the_optimum_does_not_follow():
    """A wall takes the part of a load along its normal n: it exerts -n (n . load).

    Of a load along the wall that is nothing, and not its rounding either.
    """
    n = np.array([0.6, 0.8, 0.0])
    equations = Equations(walls([n], [0], []))
    for load, along in (([1.0, 2.0, 3.0], 2.2), ([-8.0, 6.0, 0.1], 0.0)):
        found = equations.rates(rates([n], load=load))
        assert_relative(found.exerted[:, 0], -along * n, ROUNDING)


def test_rows_that_lose_their_load_touch_without_it():
    """Of walls 0 and 1 that bear load, 2 and 3 without load and 4 and 5 that are away."""
    touching = walls(np.eye(6), [0, 1], [2, 3])
    away = replace(touching, open=np.array([[4, 0], [5, 0]]), slack=np.array([0.4, 0.5]))
    found = away.unloaded(np.array([[1, 0], [2, 0], [4, 0]]))
    assert found.strict[:, 0].tolist() == [0]
    assert sorted(found.idle[:, 0].tolist()) == [1, 2, 3, 4]
    assert (found.open.tolist(), found.slack.tolist()) == ([[5, 0]], [0.5])


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
        assert all(contacts == (0, 1) for contacts in found)
