"""Every pair of solids: a sample of validation/make/pair_distances.py, and corners near edges."""

import numpy as np
import pytest

from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import Box
from tests.oracles import closest
from tests.tolerances import CLOSED_FORM, CURVED_PAIR, WAY_OUT
from validation.make.pair_distances import pair_errors

NORMAL_BESIDE = 1e-10
"""Error of the normal of points 1e-5 m apart [-]: places of decimetres are right to 1e-16 m."""


def by_coal(names: tuple[str, str]) -> bool:
    return bool(closest.CURVED & set(names)) and not {"sphere", "half-space"} & set(names)


@pytest.mark.parametrize("names", closest.pairs(), ids="-".join)
def test_a_pair_is_as_far_apart_as_another_computation_says(names: tuple[str, str]) -> None:
    atol = CURVED_PAIR if by_coal(names) else CLOSED_FORM
    worst, _, refused = pair_errors(names, 8)
    assert refused <= by_coal(names)  # where one is deep inside the other
    assert worst.pop("points") <= max(atol, WAY_OUT)
    assert all(error <= atol for error in worst.values())


@pytest.mark.parametrize("off", [1e-6, 1e-8, 1e-10])
def test_just_beyond_a_face_the_normal_leans_away_from_its_edge(off: float) -> None:
    # The edge is at x = 0.1, z = 0.2: a point 1e-5 above the face and a little beyond the edge.
    up = 1e-5
    lean = np.array([off, 0.0, up]) / np.hypot(off, up)
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.3, 0.3) for z in (-0.2, 0.2)])
    point = np.array([0.1 + off, 0.05, 0.2 + up])
    for shape in (convex_hull(corners), Box(np.array([0.1, 0.3, 0.2]))):
        phi, n = shape.signed_distance(point[None])
        np.testing.assert_allclose(n[0], lean, rtol=0, atol=NORMAL_BESIDE)
        np.testing.assert_allclose(phi[0], np.hypot(off, up), rtol=0, atol=CLOSED_FORM)


@pytest.mark.parametrize("beyond", [1e-6, 3e-8, 1e-9, -1e-9, -1e-6])
@pytest.mark.parametrize("up", [1e-5, 0.05])
def test_a_corner_near_the_edge_of_another_solid(beyond: float, up: float) -> None:
    # A tip above the face z = 0.2, a little past its edge at x = 0.1 or within it. Distances to
    # face and edge differ by beyond^2 / (2 up), less than float64 has: where the foot is decides.
    lean = np.array([max(beyond, 0.0), 0.0, up])
    lean = lean / np.sqrt(lean @ lean)
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.3, 0.3) for z in (-0.2, 0.2)])
    tip = np.array([0.1 + beyond, 0.05, 0.2 + up])
    ways = np.array([[0, 0, 0], [0.03, 0.01, 0.05], [-0.02, 0.03, 0.06], [0.01, -0.03, 0.07]])
    here = np.eye(3), np.zeros(3)
    other = ShapeInWorld(convex_hull(tip + ways), *here)
    for shape in (convex_hull(corners), Box(np.array([0.1, 0.3, 0.2]))):
        for one, two, sign in (
            (ShapeInWorld(shape, *here), other, 1),
            (other, ShapeInWorld(shape, *here), -1),
        ):
            _, alpha, beta, n = solid_pair("p", one, two)
            np.testing.assert_allclose(sign * n, lean, rtol=0, atol=NORMAL_BESIDE)
            np.testing.assert_allclose(alpha if sign < 0 else beta, tip, rtol=0, atol=CLOSED_FORM)
