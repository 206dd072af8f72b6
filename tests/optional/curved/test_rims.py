"""Crossings of rims, however the discs are tilted: quadratic equations, and circles in a plane."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cone, Cylinder
from quasistatic_ref.contact.crossings import Crossings
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.rims import curve_crossings
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

UP = np.array([0.0, 0.0, 1.0])
STRAIGHT = np.eye(3)
WORLD = Rotation.from_rotvec([0.7, -0.4, 1.9]).as_matrix()
AT = np.array([0.3, -0.2, 0.5])
TILTED = Rotation.from_rotvec([[0.1, 0.05, 0.3], [-0.08, 0.12, 1.0]]).as_matrix()
"""Both caps that face each other are within 0.25 rad of the normal."""
TABLE = Box((0.2, 0.15, 0.01))
LINE, LOWER, UPPER, CURVES, EDGES = 0, 1, 2, 3, 12
"""Numbers of the curves of a solid of revolution, how many it has, and a box."""


def moved_crossings(a, b, alpha, beta, n=UP, R=STRAIGHT, t=(0, 0, 0)):
    """Crossings of solids that are moved to elsewhere, and back again."""
    a, b = (ShapeInWorld(one.shape, R @ one.R, R @ one.t + t) for one in (a, b))
    found = curve_crossings(a, b, R @ alpha + t, R @ beta + t, R @ n)
    return Crossings((found.alpha - t) @ R, (found.beta - t) @ R, found.number)


def holds(found, expected):
    """Hold crossings, in any order, against a list of number, alpha and beta."""
    assert sorted(found.number) == sorted(number for number, _, _ in expected)
    order = np.argsort(found.number)
    for at, (_, alpha, beta) in zip(order, sorted(expected, key=lambda one: one[0]), strict=True):
        assert_within(found.alpha[at], alpha, ROUNDING)
        assert_within(found.beta[at], beta, ROUNDING)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("shape", [Cylinder(0.08, 0.02), Cone(0.08, 0.3)])
@pytest.mark.parametrize("place", [(0.17, 0.02, 0.03), (0.17, 0.12, 0.03), (0.0, 0.12, 0.03)])
def test_edges_cross_the_rim_of_a_disc_where_a_quadratic_says(place, shape, swapped):
    R, S = TILTED
    low = ShapeInWorld(TABLE, R, np.zeros(3))
    axis = S[:, 2]
    c = np.array(place)
    top = ShapeInWorld(shape, S, c + shape.half_length * axis)
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
    holds(moved_crossings(a, b, x, x, n, WORLD, AT), expected)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("d", [0.04, 0.1])
def test_rims_cross_where_their_circles_do_in_the_planes_of_both(d, swapped):
    R, S = TILTED
    r = 0.07
    s = 0.05
    centres = np.array([[0.0, 0.0, 0.0], [d, 0.0, 0.05]])
    low = ShapeInWorld(Cylinder(r, 0.01), R, centres[0] - 0.01 * R[:, 2])
    top = ShapeInWorld(Cone(s, 0.3), S, centres[1] + 0.3 * S[:, 2])
    along = (d**2 + r**2 - s**2) / (2 * d)
    expected = []
    for which, y in enumerate(np.sqrt(r**2 - along**2) * np.array([-1.0, 1.0])):
        x = np.array([along, y, 0.0])
        alpha, beta = (
            x + axis @ (c - x) / axis[2] * UP
            for axis, c in zip((R[:, 2], S[:, 2]), centres, strict=True)
        )
        one = (2 * (UPPER * CURVES + LOWER) + which, alpha, beta)
        other = (2 * (LOWER * CURVES + UPPER) + which, beta, alpha)
        expected.append(other if swapped else one)
    near = np.zeros(3)
    a, b, n = (top, low, -UP) if swapped else (low, top, UP)
    holds(moved_crossings(a, b, near, near, n, WORLD, AT), expected)


def test_an_edge_that_ends_on_a_rim_crosses_it_there():
    """A circle of 1/8 about (1/4, y) through the corner (1/4, 2 y), in numbers without rounding."""
    table = ShapeInWorld(Box((0.25, 0.25, 0.0625)), STRAIGHT, np.zeros(3))
    for y in (-0.125, 0.125):
        puck = ShapeInWorld(Cylinder(0.125, 0.0625), STRAIGHT, np.array([0.25, y, 0.125]))
        found = moved_crossings(table, puck, puck.t - 0.0625 * UP, puck.t - 0.0625 * UP)
        expected = sorted([[0.25, 0.0, 0.0625], [0.25, 2 * y, 0.0625]])
        np.testing.assert_array_equal(sorted(found.alpha.tolist()), expected)
