"""Layer distance: closed forms by hand, two ways to one answer, uniqueness, the package's own."""

from dataclasses import replace
from math import isqrt

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.rotation import rotation, turn
from quasistatic_ref.lab.vectors.challenge import fresh
from quasistatic_ref.lab.vectors.distances.shapes import placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness
from quasistatic_ref.lab.vectors.exact.algebra import vector
from quasistatic_ref.lab.vectors.exact.precision import cos_sin, number
from quasistatic_ref.lab.vectors.layers import distance
from quasistatic_ref.lab.vectors.unrounded.grid import on_grid, working
from tests.lab.vectors.material import cases
from tests.lab.vectors.solids import (
    FLOOR,
    ON_SIDE,
    ORIGIN,
    at,
    box,
    cone,
    convex,
    cylinder,
    ellipsoid,
    sphere,
)

SHAPES = {kind: {"kind": kind, **sizes} for kind, sizes in fresh.SHAPES.items()}
CASES = {case.id: case.input for case in cases("distance")[:171]}
"""Those of no scenario."""
NINETY_DIGITS = fmpq(1, 10**90)
"""Of numbers that are rounded to 96 decimal places."""


def case(alpha, pose_alpha, beta, pose_beta):
    return {"alpha": alpha, "beta": beta, "pose_alpha": pose_alpha, "pose_beta": pose_beta}


def answer(*args):
    """Expected output and whether it is unique."""
    output, _, unique = distance.answer(case(*args))
    return {key: value[0] for key, value in output.items()}, unique[0]


CUBE = box(1, 1, 1)
SMALL = box(0.5, 0.5, 0.5)
EIGHTH = np.sqrt(2) - 1
"""tan(pi / 8): a quaternion's part of the eighth of a turn."""
CLOSED_FORMS = {
    # name: (alpha, its pose, beta, its pose, unique, fields)
    # Centres (0.375, 0.5, 0) apart, of length 0.625.
    "balls": (
        sphere(0.25), ORIGIN, sphere(0.125), at(0.375, 0.5, 0.0), True,
        {"phi": 0.25, "alpha": [0.15, 0.2, 0.0], "beta": [0.3, 0.4, 0.0], "n": [0.6, 0.8, 0.0]},
    ),
    # (0.25, 0.375, 0.75) apart, of length 0.875.
    "corners": (
        CUBE, ORIGIN, SMALL, at(1.0, 1.125, 1.5), True,
        {"phi": 0.875, "alpha": [0.5, 0.5, 0.5], "beta": [0.75, 0.875, 1.25]},
    ),
    # 0.1875 deep along x, 0.25 along y, 0.5 along z: out along x; the faces share a rectangle.
    "penetration": (
        CUBE, ORIGIN, SMALL, at(0.5625, 0.5, 0.25), False,
        {"phi": -0.1875, "n": [1.0, 0.0, 0.0]},
    ),
    # Edges of half diagonal sqrt(1/2), turned about x and about y, 2 apart.
    "crossed edges": (
        CUBE, at(0.0, 0.0, 0.0, [EIGHTH, 0.0, 0.0, 1.0]),
        CUBE, at(0.0, 0.0, 2.0, [0.0, EIGHTH, 0.0, 1.0]), True,
        {"phi": 2 - np.sqrt(2), "n": [0.0, 0.0, 1.0]},
    ),
    # The side's normal is (4, 3) / 5 in (r, z): from (1.5, 0) + 2 (4, 3) / 5 it is 2 away.
    "cone": (
        cone(3.0, 4.0), ORIGIN, sphere(0.5), at(3.1, 0.0, 1.2), True,
        {"phi": 1.5, "n": [0.8, 0.0, 0.6]},
    ),
    # The axes cross at right angles, 1 apart.
    "cylinders": (
        cylinder(0.25, 2.0), ORIGIN, cylinder(0.5, 2.0), at(1.0, 0, 0, ON_SIDE), True,
        {"phi": 0.25, "alpha": [0.25, 0, 0], "beta": [0.5, 0, 0], "n": [1, 0, 0]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_pairs_have_the_distance_of_their_closed_form(name):
    *given, is_unique, wanted = CLOSED_FORMS[name]
    found, unique = answer(*given)
    assert unique is is_unique
    for field, value in wanted.items():
        np.testing.assert_allclose(found[field], value, rtol=0, atol=1e-15, err_msg=field)


@pytest.mark.parametrize("axis", [(2, 1, 2), (1, -2, 2), (6, 3, -2)])
def test_a_pose_rounded_in_its_hundredth_digit_still_has_flat_faces(axis):
    # A tetrahedron's tip 0.1 m below the top of a cube, both turned by one radian: the cosine is
    # rounded, and the matrix no rotation beyond the 96th digit.
    axis = [fmpq(x, isqrt(sum(y * y for y in axis))) for x in axis]
    with working():
        R = on_grid(turn(axis, *cos_sin(fmpq(1))))
        tips = [[0.0, 0.0, -0.25], [0.2, 0.1, 0.2], [-0.1, 0.2, 0.25], [-0.15, -0.2, 0.3]]
        solids = [
            replace(placed(shape, ORIGIN), R=R, t=R @ vector([0, 0, z]))
            for shape, z in ((box(1, 1, 1), fmpq(0)), (convex(tips), number(0.65)))
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
    np.testing.assert_allclose(np.abs(found["alpha"]), [x, y, 0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(found["phi"], -np.hypot(x, y - 0.1), rtol=0, atol=1e-15)


def test_two_rims_askew_are_where_a_fine_search_finds_them():
    # The rims of two cylinders on 2,000 points each: the search is off by a step squared.
    given = CASES["distance/corner/cylinders_rims"]
    a, pose_a, b, pose_b = (given[key] for key in ("alpha", "pose_alpha", "beta", "pose_beta"))
    found, _ = answer(a, pose_a, b, pose_b)
    R = rotation(pose_b["quaternion"])
    angle = np.linspace(0, 2 * np.pi, 2000)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(2000)], axis=1)
    upper = a["radius"] * ring + [0, 0, a["length"] / 2]
    lower = (b["radius"] * ring - [0, 0, b["length"] / 2]) @ R.T + pose_b["xyz"]
    searched = np.sqrt(((upper[:, None] - lower) ** 2).sum(axis=2).min())
    assert -1e-15 <= searched - found["phi"] <= 1e-5


@pytest.mark.parametrize("other", ["sphere", "box", "capsule", "convex", "cylinder", "halfspace"])
def test_a_box_is_its_eight_corners(other):
    # The box has closed forms of its own against points; its corners go by facets.
    corners = [[x, y, z] for x in (-0.15, 0.15) for y in (-0.25, 0.25) for z in (-0.2, 0.2)]
    where = at(0.1, 0.2, 0.3, [0.1, 0.2, 0.3, 0.4]), at(0.4, 0.4, 0.6, [0.5, 0.1, -0.2, 0.3])
    found = answer(box(0.3, 0.5, 0.4), where[0], SHAPES[other], where[1])
    assert found == answer(convex(corners), where[0], SHAPES[other], where[1])


@pytest.mark.parametrize("kind", ["box", "cylinder", "cone", "ellipsoid"])
def test_alpha_is_on_the_surface_and_as_far_as_phi_says(kind):
    pose = at(0.1, -0.2, 0.3, [0.1, 0.5, -0.3, 0.8])
    reach = np.linspace(0.05, 1, 20)[:, None]
    points = pose["xyz"] + reach * np.random.default_rng(8).uniform(-0.5, 0.5, (20, 3))
    cloud = {"kind": "cloud", "points": points.round(3).tolist()}
    found, _, _ = distance.answer(case(SHAPES[kind], pose, cloud, ORIGIN))
    back, _, _ = distance.answer(
        case(SHAPES[kind], pose, cloud | {"points": found["alpha"]}, ORIGIN)
    )
    np.testing.assert_allclose(back["phi"], 0, rtol=0, atol=1e-15)
    apart = np.linalg.norm(np.subtract(found["beta"], found["alpha"]), axis=1)
    np.testing.assert_allclose(apart, np.abs(found["phi"]), rtol=0, atol=1e-15)
    assert min(found["phi"]) < 0 < max(found["phi"])


@pytest.mark.parametrize("id_", list(CASES)[::7])
def test_exchanging_the_sides_exchanges_the_answer(id_):
    given = CASES[id_]
    turned = case(given["beta"], given["pose_beta"], given["alpha"], given["pose_alpha"])
    (one, _, unique), (other, _, _) = distance.answer(given), distance.answer(turned)
    assert one["phi"] == other["phi"]
    if all(unique):
        assert one["alpha"] == other["beta"]
        assert one["n"] == (-np.array(other["n"]) + 0.0).tolist()


def test_a_corner_that_rounding_chooses_is_not_called_unique():
    # Tilted by 1e-17 rad a cube stands on one corner, and by four units of rounding on another.
    tilted = at(0.0, 0.0, 0.5, [5e-18, 3e-18, 0.0, 1.0])
    given = case(FLOOR, ORIGIN, box(1, 1, 1), tilted)
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
        (cylinder(1.0, 1.0), cylinder(1.0, 1.0), "meet"),
        (cone(1.0, 1.0), ellipsoid(1.0, 1.0, 1.0), "no closed form"),
        (SHAPES["halfspace"], SHAPES["halfspace"], "two halfspaces"),
        ({"kind": "ball"}, sphere(1.0), "kind of shape"),
        ({"kind": "sphere", "length": 1.0}, sphere(1.0), "has the fields"),
        (convex([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), sphere(1.0), "plane"),
    ],
)
def test_what_has_no_exact_answer_is_refused(alpha, beta, match):
    with pytest.raises(InputError, match=match):
        answer(alpha, ORIGIN, beta, at(0.25, 0.0, 0.0))
