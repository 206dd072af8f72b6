"""Faces of friction cones: all of each shape, and fewer where rows do not differ."""

import numpy as np
import pytest
from flint import fmpz

from quasistatic_ref.optional.coulomb.cone_faces import faces
from quasistatic_ref.step.cones import cone


def of_cone(name, mu=(1, 1, 1), rows=slice(None)):
    """The faces of a cone, with friction coefficients that are whole numbers."""
    corners = np.ldexp(cone(name).matrix[rows, 1:], 60) * mu
    return faces([[fmpz(int(x)) for x in corner] for corner in corners])


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("pyramid", {1: 6, 2: 12, 3: 8, 6: 1}),  # an octahedron
        ("product", {1: 8, 2: 12, 4: 6, 8: 1}),  # a cuboid
        ("facets-8", {1: 10, 2: 24, 3: 16, 10: 1}),  # two pyramids over an octagon
        ("frictionless", {1: 1}),
    ],
)
def test_a_cone_has_the_faces_of_its_polyhedron(name, sizes):
    found = of_cone(name)
    assert len(set(found)) == len(found)
    assert {size: [len(face) for face in found].count(size) for size in sizes} == sizes
    assert len(found) == sum(sizes.values())
    assert found[-1] == tuple(range(len(cone(name).matrix)))


def test_rows_that_do_not_differ_share_their_faces():
    # Without torsion a square; where nothing slides along d2, or rubs, a segment; or a point.
    assert [len(face) for face in of_cone("pyramid", rows=slice(4))] == [1] * 4 + [2] * 4 + [4]
    assert of_cone("pyramid", (1, 0, 0)) == [(0,), (2,), (0, 1, 2, 3, 4, 5)]
    assert of_cone("pyramid", (0, 0, 1)) == [(4,), (5,), (0, 1, 2, 3, 4, 5)]
    assert of_cone("pyramid", (0, 0, 0)) == [(0, 1, 2, 3, 4, 5)]
