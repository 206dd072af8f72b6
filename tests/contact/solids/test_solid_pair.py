"""Every pair of solids: a sample of validation/make/pair_distances.py, and points near edges."""

import numpy as np
import pytest

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
