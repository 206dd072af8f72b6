"""Crossings of rims and edges, however the discs are tilted: quadratic equations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cone, Cylinder
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.rims import curve_crossings
from quasistatic_ref.tolerances import SKEW
from tests.closeness import assert_within
from tests.contact.still import in_world

UP = np.array([0.0, 0.0, 1.0])
WORLD = Rotation.from_rotvec([0.7, -0.4, 1.9]).as_matrix()
AT = np.array([0.3, -0.2, 0.5])
TILTED = Rotation.from_rotvec([[0.1, 0.05, 0.3], [-0.08, 0.12, 1.0]]).as_matrix()
"""Both caps that face each other are within 0.25 rad of the normal."""
TABLE = Box((0.2, 0.15, 0.01))
LOWER, CURVES, EDGES = 1, 3, 12
"""Numbers of the curves of a solid of revolution, how many it has, and a box."""


def moved_crossings(a, b, x, n=UP):
    """Crossings of solids about a point that are moved to elsewhere, and back again."""
    a, b = (in_world(one.shape, WORLD @ one.t + AT, WORLD @ one.R) for one in (a, b))
    there = WORLD @ x + AT
    found = curve_crossings(a, b, there, there, WORLD @ n)
    alpha, beta = ((of - AT) @ WORLD for of in (found.alpha, found.beta))
    return found._replace(alpha=alpha, beta=beta)


def holds(found, expected):
    """Hold crossings, in any order, against a list of number, alpha and beta."""
    assert sorted(found.number) == sorted(number for number, _, _ in expected)
    order = np.argsort(found.number)
    for at, (_, alpha, beta) in zip(order, sorted(expected, key=lambda one: one[0]), strict=True):
        assert_within(found.alpha[at], alpha)
        assert_within(found.beta[at], beta)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("shape", [Cylinder(0.08, 0.02), Cone(0.08, 0.3)])
@pytest.mark.parametrize("place", [(0.17, 0.02, 0.03), (0.17, 0.12, 0.03), (0.0, 0.12, 0.03)])
def test_edges_cross_the_rim_of_a_disc_where_a_quadratic_says(place, shape, swapped):
    R, S = TILTED
    low = in_world(TABLE, R=R)
    axis = S[:, 2]
    c = np.array(place)
    top = in_world(shape, c + shape.half_length * axis, S)
    flat = polytope(TABLE)
    expected = []
    for edge, ends in enumerate(flat.vertices[flat.edges]):
        if (ends[:, 2] < 0).any():
            continue
        tail, head = ends @ R.T

        def both(s, tail=tail, head=head):
            x = tail + s * (head - tail)
            return x, x + axis @ (c - x) / axis[2] * UP  # the point over x in the rim's plane

        def miss(s, both=both):
            away = both(s)[1] - c
            return away @ away - shape.radius**2

        shares = (0.0, 0.5, 1.0)
        quadratic = np.polyfit(shares, [miss(s) for s in shares], 2)
        for which, s in enumerate(np.sort_complex(np.roots(quadratic))):
            if s.imag == 0 and 0 <= s.real <= 1:
                x, y = both(s.real)
                one = (2 * (edge * CURVES + LOWER) + which, x, y)
                other = (2 * (LOWER * EDGES + edge) + which, y, x)
                expected.append(other if swapped else one)
    assert expected
    x = R @ [0.1, 0.1, 0.01]
    a, b, n = (top, low, -UP) if swapped else (low, top, UP)
    holds(moved_crossings(a, b, x, n), expected)


def test_rims_cross_where_their_circles_do():
    """Triangles of sides 5, 12, 13 and 9, 12, 15."""
    low = in_world(Cylinder(0.13, 0.01))
    top = in_world(Cylinder(0.15, 0.01), (0.14, 0.0, 0.02))
    x = np.array([0.05, 0.0, 0.01])
    found = moved_crossings(low, top, x)
    expected = [[0.05, -0.12, 0.01], [0.05, 0.12, 0.01]]
    assert_within(found.alpha[found.alpha[:, 1].argsort()], expected)


def test_an_edge_that_ends_on_a_rim_crosses_it_there():
    """A circle of 1/8 about (1/4, 1/8) through the corner (1/4, 1/4), without rounding."""
    table = in_world(Box((0.25, 0.25, 0.0625)))
    puck = in_world(Cylinder(0.125, 0.0625), (0.25, 0.125, 0.125))
    x = puck.t - 0.0625 * UP
    found = curve_crossings(table, puck, x, x, UP)
    assert sorted(found.alpha.tolist()) == [[0.25, 0.0, 0.0625], [0.25, 0.25, 0.0625]]


@pytest.mark.parametrize(("share", "count"), [(2.0, 2), (0.5, 0)])
def test_circles_of_one_size_cross_unless_their_centres_all_but_coincide(share, count):
    away = share * SKEW * 0.08
    low = in_world(Cylinder(0.08, 0.01))
    top = in_world(Cylinder(0.08, 0.01), (away, 0.0, 0.02))
    assert len(moved_crossings(low, top, np.array([0.0, 0.0, 0.01])).number) == count
