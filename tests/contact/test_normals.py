"""Which normals of two solids are tied, by hand."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, ContactError, Sphere, convex_hull
from quasistatic_ref.contact.normals import BISECTOR, UNIQUE_NORMAL, gaps, pair_normal, rounding
from tests.closeness import assert_within
from tests.contact.still import in_world as at
from tests.tolerances import CLOSED_FORM

X, Y, Z = np.eye(3)
CUBE = Box(np.ones(3))
CAPSULE = Capsule(0.25, 1.0)
TO_X = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
TO_Y = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def test_closest_points_are_apart_by_the_distance_along_a_normal_between_two():
    # Cubes with an edge in common but for 1e-10 along both sides.
    depth = 1e-10
    found, tie = pair_normal("p", at(CUBE), at(CUBE, [2 - depth, 0.0, 2 - depth]))
    between = (X + Z) / np.sqrt(2)
    assert_within(found.n, between, CLOSED_FORM)
    assert_within(found.phi, -np.sqrt(2) * depth, CLOSED_FORM)
    way = found.beta - found.alpha
    assert_within(way, -np.sqrt(2) * depth * between, CLOSED_FORM)
    assert tie == BISECTOR


@pytest.mark.parametrize(
    ("a", "b"),
    [
        # Axes that cross: out along either side of their plane.
        (at(CAPSULE, R=TO_X), at(CAPSULE, R=TO_Y)),
        # An edge in an edge: out along two.
        (at(CUBE), at(CUBE, [1.5, 0.0, 1.5])),
        # A corner in a corner: out along three normals.
        (at(CUBE), at(CUBE, [1.5, 1.5, 1.5])),
    ],
)
def test_solids_as_deep_along_several_normals_are_refused(a, b):
    with pytest.raises(ContactError, match=r"along \[.*\] as along \[.*\], 0.5 m: ") as refusal:
        pair_normal("p", a, b)
    assert "-0." not in str(refusal.value)


def turned_apart(turn, solid=CUBE, away=0.0):
    """Two solids, one over the other, turned by as much: one to the right and one to the left."""
    right, left = (Rotation.from_rotvec(angle * Y).as_matrix() for angle in (turn, -turn))
    place = away * X
    return at(solid, place, R=right), at(solid, place + 1.99 * Z, left)


@pytest.mark.parametrize("turn", [1e-4, 0.1])
def test_faces_that_turn_into_each_other_want_more_contacts(turn):
    with pytest.raises(ContactError, match=r"not defined; raise k of contacts.grip: a face that"):
        pair_normal("grip(a, b)", *turned_apart(turn))
    with pytest.raises(ContactError, match=r"not defined; start them apart$"):
        pair_normal("grip(a, b)", *turned_apart(turn), may_raise_k=False)


@pytest.mark.parametrize(
    ("turn", "solid", "away"),
    [
        (1e-6, CUBE, 0.0),
        (1.9e-5, CUBE, 0.0),
        (1.9e-5, convex_hull(CUBE.corners(Z)[0]), 0.0),
        (1e-4, CUBE, 100.0),  # there gaps are right to ten times less
    ],
)
def test_faces_that_are_nearly_parallel_have_the_mean_of_their_normals(turn, solid, away):
    """Along z each reaches cos t + sin t from its middle, and the middles are 1.99 apart."""
    a, b = turned_apart(turn, solid, away)
    nearest, tie = pair_normal("p", a, b)
    assert tie == BISECTOR
    assert_within(nearest.n, Z, CLOSED_FORM)
    assert abs(nearest.phi - (1.99 - 2 * (np.cos(turn) + np.sin(turn)))) <= rounding(a, b)
    pushed_out = b._replace(t=b.t - nearest.phi * nearest.n)
    normals = np.array([a.R @ Z, b.R @ Z])
    assert gaps(a, pushed_out, normals).min() >= -rounding(a, b)


@pytest.mark.parametrize("shape", [CAPSULE, Sphere(0.25)])
def test_cores_that_are_apart_have_one_normal_however_near_another_gap_is(shape):
    """A core is d (cos a, sin a) beyond a cube's edge: nearly as far as beyond its face, d cos a.

    An end of the capsule's core is there, from where it goes along x, away from the cube.
    """
    rng = np.random.default_rng(0)
    along = X if shape is CAPSULE else 0 * X
    for d in 10 ** rng.uniform(-8, -1, 50):
        a = min(1.0, np.sqrt(2e-12 / d) * rng.uniform(0.1, 1.0))
        way = d * np.array([np.cos(a), np.sin(a), 0.0])
        R = Rotation.random(rng=rng).as_matrix()
        placed = (at(CUBE, R=R), at(shape, R @ (X + Y + way + along), R @ TO_X))
        for (one, other), sign in ((placed, 1), (placed[::-1], -1)):
            found, tie = pair_normal("p", one, other)
            assert tie == UNIQUE_NORMAL
            assert_within(found.phi, d - 0.25, CLOSED_FORM)
            assert_within(d * found.n, sign * R @ way, CLOSED_FORM)


def test_cores_that_are_apart_by_rounding_are_refused_in_an_edge():
    with pytest.raises(ContactError, match=r"as deep in each other along \[.*\], 0.25 m: "):
        pair_normal("p", at(CUBE), at(CAPSULE, [2 + 1e-13, 1 + 1e-13, 0.0], TO_X))


def test_capsules_whose_axes_are_apart_by_rounding_are_tied_where_their_two_gaps_are_equal():
    """Axes d apart along z: gaps of d - 0.5 along z and -d - 0.5 the other way."""
    within = rounding(at(CAPSULE), at(CAPSULE))
    a, b, c = (at(CAPSULE, t, R) for t, R in (
        (np.zeros(3), TO_X), (0.75 * within * Z, TO_Y), (0.25 * within * Z, TO_Y)
    ))  # fmt: skip
    assert pair_normal("p", a, b)[1] == UNIQUE_NORMAL
    with pytest.raises(ContactError, match="as deep in each other"):
        pair_normal("p", a, c)
