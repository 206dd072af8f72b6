"""Every row of SOLIDS: reach, distance and corners agree, however they are computed.

The sizes of a row are drawn from its fields, so a solid is tested by having a row.
"""

import numpy as np
import pytest

from quasistatic_ref.files.scenario.world_solids import SOLIDS
from tests.closeness import assert_within

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
