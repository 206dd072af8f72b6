"""Every row of SOLIDS: reach, distance and corners agree, however they are computed.

The sizes of a row are drawn from its fields, so a solid is tested by having a row.
"""

import numpy as np
import pytest

from quasistatic_ref import Box
from quasistatic_ref.files.scenario.world_solids import SOLIDS
from tests.closeness import assert_relative, assert_within
from tests.contact.still import in_world
from tests.made import crossings, solid_pair

UNBOUNDED = {"halfspace"}
BOUNDED = sorted(SOLIDS.keys() - UNBOUNDED)
REFINED = 1e-9
"""Of distances of curved solids, which are refined [m]."""

TETRAHEDRON = "".join(f"v {x} {y} {z}\n" for x, y, z in (*np.eye(3), (0, 0, 0)))
FACES = "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n"


def drawn(kind, rng, folder):
    """A solid of a kind, some decimetres long."""
    mesh = folder / "mesh.obj"
    mesh.write_text(TETRAHEDRON + FACES, "utf-8")
    values = {
        "number": lambda: rng.uniform(0.05, 0.3),
        "three numbers": lambda: rng.uniform(0.05, 0.3, 3),
        "text": lambda: mesh,
    }
    sizes = {name: values[field.kind]() for name, field in SOLIDS[kind].fields.items()}
    return SOLIDS[kind].made(**sizes)


def directions(rng, count):
    n = rng.normal(size=(count, 3))
    return n / np.linalg.norm(n, axis=1, keepdims=True)


@pytest.mark.parametrize("kind", BOUNDED)
def test_the_farthest_point_is_on_the_surface_and_the_farthest_corner_as_far(kind, tmp_path):
    rng = np.random.default_rng(0)
    for _ in range(10):
        solid = drawn(kind, rng, tmp_path)
        n = directions(rng, 30)
        reach = solid.support_value(n)
        farthest = np.array([solid.support_point(one) for one in n])
        assert_within((farthest * n).sum(1), reach, REFINED)
        assert_within(solid.signed_distance(farthest)[0], np.zeros(30), REFINED)
        assert_within(solid.signed_distance(farthest + 0.1 * n)[0], np.full(30, 0.1), REFINED)
        for one, far in zip(n, reach, strict=True):
            corners, radius = solid.corners(one)
            if len(corners):
                assert_within((corners @ one + radius).max(), far, REFINED)
            assert_within(solid.signed_distance(corners)[0], [-radius] * len(corners), REFINED)


@pytest.mark.parametrize("kind", SOLIDS)
def test_a_point_less_its_distance_along_the_normal_is_on_the_surface(kind, tmp_path):
    """Also of a point inside; and the distance grows along the normal."""
    rng = np.random.default_rng(1)
    inside = []
    for _ in range(10):
        solid = drawn(kind, rng, tmp_path)
        p = rng.uniform(-0.5, 0.5, (200, 3)) * rng.uniform(size=(200, 1))
        phi, n = solid.signed_distance(p)
        inside += (phi < 0).tolist()
        assert_within((n * n).sum(1), np.ones(200), REFINED)
        assert_within(solid.signed_distance(p - phi[:, None] * n)[0], np.zeros(200), REFINED)
        way = 0.1 * np.abs(phi)
        assert_within(solid.signed_distance(p + way[:, None] * n)[0], phi + way, REFINED)
    assert 0.01 < np.mean(inside) < 0.99


@pytest.mark.parametrize("kind", SOLIDS)
def test_heights_over_faces_grow_along_normals_and_the_highest_is_the_distance_inside(
    kind, tmp_path
):
    """Outside none is larger than the distance; each face is the nearest of some point inside."""
    rng = np.random.default_rng(2)
    nearest = set()
    for _ in range(10):
        solid = drawn(kind, rng, tmp_path)
        p = rng.uniform(-0.4, 0.4, (1000, 3)) * rng.uniform(size=(1000, 1))
        phi, n = solid.signed_distance(p)
        heights, normals = solid.faces(p)
        assert (heights <= phi[:, None] + REFINED).all()
        for k in range(heights.shape[1]):
            higher, _ = solid.faces(p + 0.1 * normals[:, k])
            assert_within(higher[:, k], heights[:, k] + 0.1, REFINED)
        if heights.shape[1]:
            inside = np.flatnonzero(phi < 0)
            highest = heights[inside].argmax(axis=1)
            assert_within(heights[inside, highest], phi[inside])
            assert_within(normals[inside, highest], n[inside])
            nearest |= set(highest)
    assert len(nearest) == heights.shape[1]


@pytest.mark.parametrize("kind", BOUNDED)
def test_the_volume_is_that_of_the_points_inside(kind, tmp_path):
    solid = drawn(kind, np.random.default_rng(3), tmp_path)
    low, high = -solid.support_value(-np.eye(3)), solid.support_value(np.eye(3))
    cells = (np.stack(np.meshgrid(*[np.arange(60)] * 3), axis=-1).reshape(-1, 3) + 0.5) / 60
    inside = solid.signed_distance(low + cells * (high - low))[0] < 0
    assert_relative(solid.volume, inside.mean() * np.prod(high - low), 0.01)


@pytest.mark.parametrize("kind", [kind for kind in BOUNDED if kind not in ("sphere", "ellipsoid")])
def test_the_crossings_with_a_bar_below_are_no_more_than_the_edges_allow(kind, tmp_path):
    solid = drawn(kind, np.random.default_rng(4), tmp_path)
    lies = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]) if kind == "capsule" else np.eye(3)
    height = solid.support_value(-lies[2:])[0]
    bar = in_world(Box((0.02, 2.0, 0.1)), (0.02, 0.0, -0.06))
    above = in_world(solid, (0.0, 0.0, height), lies)
    near = solid_pair("pair", bar, above)
    found = crossings(bar, above, near.alpha, near.beta, near.n)
    assert 0 < len(found.alpha) <= 2 * min(bar.shape.edge_count, solid.edge_count)
