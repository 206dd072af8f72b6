"""Every row of SOLIDS: reach, distance, corners and closest points agree, however it is computed.

The sizes of a row are drawn from its fields, so a solid is tested by having a row.
"""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.files.scenario.world_solids import SOLIDS
from tests.closeness import assert_within
from tests.contact.still import in_world

UNBOUNDED = {"halfspace"}
BOUNDED = sorted(SOLIDS.keys() - UNBOUNDED)
PAIRS = [
    *itertools.combinations_with_replacement(BOUNDED, 2),
    *itertools.product(UNBOUNDED, BOUNDED),
]
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
def test_the_farthest_point_is_on_the_surface_and_no_corner_is_farther(kind, tmp_path):
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
            assert (corners @ one + radius <= far + REFINED).all()
            assert (solid.signed_distance(corners)[0] <= REFINED - radius).all()


@pytest.mark.parametrize("kinds", PAIRS, ids="-".join)
def test_closest_points_lie_in_both_solids_and_no_point_is_farther_along_n(kinds, tmp_path):
    """Which proves the distance of solids that are apart, whoever found it."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        a, b = (drawn(kind, rng, tmp_path) for kind in kinds)
        R_a, R_b = Rotation.random(2, random_state=rng).as_matrix()
        n = R_a @ a.normal if kinds[0] in UNBOUNDED else directions(rng, 1)[0]
        reach = a.offset if kinds[0] in UNBOUNDED else a.support_value((R_a.T @ n)[None])[0]
        # A gap along n leaves the bodies apart, wherever b is beside it.
        gap = rng.uniform(0.01, 0.1)
        t_b = n * (reach + gap + b.support_value(-(R_b.T @ n)[None])[0])
        near = solid_pair("pair", in_world(a, R=R_a), in_world(b, t_b, R_b))
        assert near.phi > gap - REFINED
        assert_within(np.linalg.norm(near.n), 1.0)
        assert_within(near.beta - near.alpha, near.phi * near.n, REFINED)
        of_a = (near.alpha @ R_a, R_a.T @ near.n)
        of_b = ((near.beta - t_b) @ R_b, -R_b.T @ near.n)
        for solid, (point, out) in ((a, of_a), (b, of_b)):
            assert abs(solid.signed_distance(point[None])[0][0]) < REFINED
            if solid.kind not in UNBOUNDED:
                assert_within(point @ out, solid.support_value(out[None])[0], REFINED)
