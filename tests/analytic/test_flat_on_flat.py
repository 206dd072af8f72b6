"""Bodies that lie flat on each other: forces and motions by hand, whatever is flush."""

from itertools import islice

import numpy as np
import pytest

from quasistatic_ref import Box
from quasistatic_ref.contact.normals import BISECTOR, OF_PAIR, SAYS, UNIQUE_NORMAL
from tests.closeness import assert_within
from tests.oracles.bodies_by_hand import (
    BOX,
    EDGE,
    FAMILIES,
    STRAIGHT,
    UP,
    Scene,
    attempts,
    elsewhere,
    step_of,
    wrong_words,
)
from tests.tolerances import CLOSED_FORM

EVERY = 37
"""Which scenes by hand are tried of each family, from another one on: 2 or 3 of 80."""


@pytest.mark.parametrize(("number", "name"), [*enumerate(FAMILIES)], ids=FAMILIES)
def test_forces_are_those_by_hand(number, name):
    rng = np.random.default_rng(number)
    scenes = islice(attempts(name), number, None, EVERY)
    said = [wrong_words(elsewhere(scene, rng), *contacts) for scene, *contacts in scenes]
    assert set(said) == {""}


def side_by_side(way, shape=BOX):
    """The step, without a load, of a body that is moved from a fixed cube's place."""
    bodies = [(shape, STRAIGHT, np.array(way)), (BOX, STRAIGHT, np.zeros(3))]
    return step_of(Scene(bodies, {(1, 0): UP}, np.zeros((1, 6)), np.zeros(6)), 8, 0.0)


def test_equal_gaps_of_zero_have_the_normal_between():
    across = side_by_side([EDGE, 0.0, EDGE])
    assert_within(across.points.n, [[np.sqrt(0.5), 0, np.sqrt(0.5)]] * 8, 1e-15)
    assert {*across.tied.values()} == {SAYS[BISECTOR]}


@pytest.mark.parametrize(("half", "tie"), [(0.5, OF_PAIR), (0.4, UNIQUE_NORMAL)])
def test_corners_over_an_edge_have_the_normal_of_the_pair_over_a_face_its_own(half, tie):
    points = side_by_side([0.0, 0.0, EDGE], Box(np.array([half, half, 0.5]) * EDGE)).points
    near = np.abs(points.phi) < CLOSED_FORM
    assert points.tie[near].tolist() == [tie] * 4
