"""Layer distance: what is exact beyond float64, uniqueness, and what has no answer."""

from dataclasses import replace
from math import isqrt

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref import InputError
from quasistatic_ref.lab.program.rotation import turn
from quasistatic_ref.lab.vectors.distances.shapes import placed_shape
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness
from quasistatic_ref.lab.vectors.exact.precision import cos_sin, number, vector
from quasistatic_ref.lab.vectors.layers import distance
from quasistatic_ref.lab.vectors.tables import FLOOR, ORIGIN, at
from tests.closeness import assert_within
from tests.lab.vectors.committed_cases import cases
from tests.oracles.grid import on_grid, working_precision

CUBE = {"kind": "box", "size": [1.0, 1.0, 1.0]}
BALL = {"kind": "sphere", "radius": 1.0}
CAN = {"kind": "cylinder", "radius": 1.0, "length": 1.0}
CASES = {case.id: case.input for case in cases("distance")[:171]}
"""Those of no scenario."""
NINETY_DIGITS = fmpq(1, 10**90)
"""Of numbers that are rounded to 96 decimal places."""


def case(alpha, pose_alpha, beta, pose_beta):
    return {"alpha": alpha, "beta": beta, "pose_alpha": pose_alpha, "pose_beta": pose_beta}


def ellipsoid(*half_axes):
    return {"kind": "ellipsoid", "half_axes": list(half_axes)}


def convex(vertices):
    return {"kind": "convex", "vertices": vertices}


def answer(*args):
    """Expected output and whether it is unique."""
    output, _, unique = distance.answer(case(*args))
    return {key: value[0] for key, value in output.items()}, unique[0]


@pytest.mark.parametrize("axis", [(2, 1, 2), (1, -2, 2), (6, 3, -2)])
def test_a_pose_rounded_in_its_hundredth_digit_still_has_flat_faces(axis):
    # A tetrahedron's tip 0.1 m below the top of a cube, both turned by one radian: the cosine is
    # rounded, and the matrix no rotation beyond the 96th digit.
    axis = [fmpq(x, isqrt(sum(y * y for y in axis))) for x in axis]
    with working_precision():
        R = on_grid(turn(axis, *cos_sin(fmpq(1))))
        tips = [[0.0, 0.0, -0.25], [0.2, 0.1, 0.2], [-0.1, 0.2, 0.25], [-0.15, -0.2, 0.3]]
        solids = [
            replace(placed_shape(shape, ORIGIN), R=R, t=R @ vector([0, 0, z]))
            for shape, z in ((CUBE, fmpq(0)), (convex(tips), number(0.65)))
        ]
        found = pair_witness(*solids)
        up = R[:, 2]
        wanted = [fmpq(1, 2) * up, (number(0.65) - fmpq(1, 4)) * up, up]
        for mine, theirs in zip((found.alpha, found.beta, found.n), wanted, strict=True):
            assert max(abs(mine - theirs)) < NINETY_DIGITS
        assert abs(found.phi + fmpq(3, 4) - number(0.65)) < NINETY_DIGITS


def test_on_the_medial_plane_of_an_ellipsoid_two_sides_are_as_near():
    # x = (0, 1/2, 1) of half-axes 1/4, 1/2, 1 at p = (0, 0.1, 0): t = -1/16 gives
    # x_y = p_y / (1 - 1/4), x_x^2 = 1/16 (1 - 4 x_y^2).
    shape = ellipsoid(0.25, 0.5, 1.0)
    found, unique = answer(shape, ORIGIN, {"kind": "sphere", "radius": 0.0}, at(0.0, 0.1, 0.0))
    y = 0.1 / 0.75
    x = np.sqrt((1 - 4 * y * y) / 16)
    assert not unique
    assert_within(np.abs(found["alpha"]), [x, y, 0], 1e-15)
    assert_within(found["phi"], -np.hypot(x, y - 0.1), 1e-15)


@pytest.mark.parametrize("id_", list(CASES)[::7])
def test_exchanging_the_sides_exchanges_the_answer(id_):
    given = CASES[id_]
    turned = case(given["beta"], given["pose_beta"], given["alpha"], given["pose_alpha"])
    one, _, unique = distance.answer(given)
    other, _, _ = distance.answer(turned)
    assert one["phi"] == other["phi"]
    if all(unique):
        assert one["alpha"] == other["beta"]
        assert one["n"] == (-np.array(other["n"]) + 0.0).tolist()


def test_a_corner_that_rounding_chooses_is_not_called_unique():
    # Tilted by 1e-17 rad a cube stands on one corner, and by four units of rounding on another.
    tilted = {"xyz": [0.0, 0.0, 0.5], "quaternion": [5e-18, 3e-18, 0.0, 1.0]}
    given = case(FLOOR, ORIGIN, CUBE, tilted)
    _, _, unique = distance.answer(given)
    found = distance.expected(given)
    assert unique == [True]
    assert found.flags == {"unique": False}
    assert found.tolerance["alpha"].absolute < 1e-13


def test_near_contact_a_difference_has_no_normal_and_the_tolerance_says_so():
    near, apart = (CASES[f"distance/cylinder_box/{name}"] for name in ("near", "apart"))
    tight, loose = (distance.expected(c).tolerance["n"] for c in (apart, near))
    assert tight.absolute < 1e-13 < loose.absolute < 1e-5
    assert "difference of near points" in loose.reason


@pytest.mark.parametrize(
    ("alpha", "beta", "match"),
    [
        (CAN, CAN, "meet"),
        ({**CAN, "kind": "cone"}, ellipsoid(1.0, 1.0, 1.0), "no closed form"),
        (FLOOR, FLOOR, "two halfspaces"),
        ({"kind": "ball"}, BALL, "kind of shape"),
        ({"kind": "sphere", "length": 1.0}, BALL, "has the fields"),
        (convex([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), BALL, "plane"),
    ],
)
def test_what_has_no_exact_answer_is_refused(alpha, beta, match):
    with pytest.raises(InputError, match=match):
        answer(alpha, ORIGIN, beta, at(0.25, 0.0, 0.0))
