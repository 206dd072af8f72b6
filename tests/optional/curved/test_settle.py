"""Normals that are off settle on the maximum of the gap near them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.curved import by_coal
from quasistatic_ref.optional.curved.settle import settled
from quasistatic_ref.shapes.placed_shape import Cylinder, Ellipsoid
from tests.contact.solids.test_curved_pair import HERE, PAIRS, SOLIDS
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_a_normal_that_is_off_by_a_thousandth_settles_where_it_was(names) -> None:
    a, b = (SOLIDS[name] for name in names)
    random = np.random.default_rng(4)
    settles = 0
    for R, t in closest.poses(6, 29):
        here = ShapeInWorld(a, *HERE)
        there = ShapeInWorld(b, R, t)
        try:
            phi, alpha, beta, n = solid_pair("p", here, there)
        except ContactError:
            continue
        off = n + 3e-4 * random.normal(size=3)
        start = Witness(phi, alpha, beta, off / np.linalg.norm(off))
        gaps = [by_coal.judged(here, there, *way) for way in settled(here, there, start)]
        settles += any(
            way.defect <= CURVED_PAIR and abs(way.phi - phi) <= CURVED_PAIR for way in gaps
        )
    assert settles >= 5


def settles_at(a: ShapeInWorld, b: ShapeInWorld, start: Witness, *expected: object) -> bool:
    """Whether one of the maxima near an approximate one has this distance, first point, normal."""
    ends = [(way.phi, way.alpha, way.n) for way in settled(a, b, start)]
    return any(
        all(
            np.abs(np.subtract(*both)).max() <= CURVED_PAIR
            for both in zip(end, expected, strict=True)
        )
        for end in ends
    )


@pytest.mark.parametrize("angle", [0.1, 0.35])
def test_a_normal_that_is_off_by_more_than_a_stride_settles_too(angle) -> None:
    # Two ellipsoids with their tips 0.2 m apart, and a normal turned about z.
    a = ShapeInWorld(Ellipsoid(np.array([0.1, 0.05, 0.04])), *HERE)
    b = ShapeInWorld(Ellipsoid(np.array([0.2, 0.03, 0.06])), np.eye(3), np.array([0.5, 0, 0]))
    start = Witness(0.2, a.t, b.t, np.array([np.cos(angle), np.sin(angle), 0]))
    assert settles_at(a, b, start, 0.5 - 0.1 - 0.2, [0.1, 0, 0], [1, 0, 0])


def test_a_cap_above_an_ellipsoid_has_the_normal_of_the_cap() -> None:
    a = ShapeInWorld(Ellipsoid(np.array([0.1, 0.05, 0.04])), *HERE)
    b = ShapeInWorld(Cylinder(0.1, 0.05), np.eye(3), np.array([0.01, 0.02, 0.04 + 0.03 + 0.05]))
    n = np.array([3e-4, -2e-4, 1.0])
    start = Witness(0.03, a.t, b.t, n / np.linalg.norm(n))
    assert settles_at(a, b, start, 0.03, [0, 0, 0.04], [0, 0, 1])


def test_where_two_caps_overlap_the_point_next_to_the_start_is_taken() -> None:
    # Discs of radius 1, 1.9 apart: what they share begins at 1.9 - 1 on the line of their centres.
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    solid = Cylinder(1.0, 0.1)
    n = R[:, 2]
    a = ShapeInWorld(solid, R, np.zeros(3))
    b = ShapeInWorld(solid, R, R @ [1.9, 0, 0.1 + 0.02 + 0.1])
    start = Witness(0.02, R @ [0.2, 0, 0.1], R @ [0.2, 0, 0.12], n)
    assert settles_at(a, b, start, 0.02, R @ [1.9 - 1, 0, 0.1], n)
