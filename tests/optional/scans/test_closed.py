"""The inside of closed meshes: as files have them, and as they should not be."""

import numpy as np
import pytest
import trimesh

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.scans.closed import closed_mesh
from quasistatic_ref.optional.scans.solid import Solid
from tests.closeness import assert_relative, assert_within

BOX = trimesh.creation.box((1.0, 2.0, 4.0))
V, F = np.array(BOX.vertices), np.array(BOX.faces)


def solid(vertices, faces, *words):
    """The solid of a mesh, of which these words are noted."""
    notes = []
    surface = closed_mesh(vertices, faces, notes)
    assert len(notes) == len(words)
    assert all(word in note for word, note in zip(words, notes, strict=True))
    return surface and Solid.of_triangles(surface[0][surface[1]])


def joined(*meshes):
    starts = np.cumsum([0, *(len(v) for v, _ in meshes)])
    faces = [f + start for (_, f), start in zip(meshes, starts, strict=False)]
    return np.concatenate([v for v, _ in meshes]), np.concatenate(faces)


def test_a_box_as_it_is_as_loose_triangles_and_off_by_a_bit():
    rng = np.random.default_rng(0)
    loose = V[F].reshape(-1, 3)
    apart = loose * (1 + 1e-7 / 4 * rng.uniform(-1, 1, loose.shape))
    for vertices, faces in (
        (V, F),
        (loose, np.arange(36).reshape(-1, 3)),
        (apart, np.arange(36).reshape(-1, 3)),
    ):
        made = solid(vertices, faces)
        assert_relative(made.volume, 8.0, 1e-6)
        assert_within(made.centre, np.zeros(3), 1e-6)
    assert solid(V, F[1:]) is None
    assert solid(V, F[:0]) is None


def test_a_mesh_that_is_wound_inwards_is_turned():
    made = solid(V + 5.0, F[:, ::-1], "wound inwards")
    assert_relative(made.volume, 8.0, 1e-12)
    assert_relative(made.centre, 5.0, 1e-12)


def test_a_triangle_that_is_turned_or_stands_twice_is_no_hole():
    mixed = np.where(np.isin(np.arange(12), [1, 7])[:, None], F[:, ::-1], F)
    assert_relative(solid(V, mixed, "2 triangles are wound against").volume, 8.0, 1e-12)
    twice = np.concatenate([F, F[3:4], F[5:6, [1, 2, 0]]])
    assert_relative(solid(V, twice, "2 triangles that stand twice").volume, 8.0, 1e-12)
    both = np.concatenate([F, F[3:4, ::-1]])
    assert_relative(solid(V, both, "1 triangles that stand twice").volume, 8.0, 1e-12)
    all_twice = np.concatenate([F, F])
    assert_relative(solid(V, all_twice, "12 triangles that stand twice").volume, 8.0, 1e-12)


def test_point_like_triangles_at_a_pole_are_no_holes():
    ball = trimesh.creation.icosphere(subdivisions=2)
    extra = np.array([[0, 0, 1], [2, 2, 2]])
    made = solid(np.array(ball.vertices), np.concatenate([ball.faces, extra]))
    assert_relative(made.volume, float(ball.volume), 1e-12)


def test_a_cavity_is_taken_away_where_the_file_says_that_it_is_one():
    hollow = joined((V, F), (V / 2, F[:, ::-1]))
    assert_relative(solid(*hollow).volume, 7.0, 1e-12)
    assert_relative(solid(hollow[0], hollow[1][:, ::-1], "inwards").volume, 7.0, 1e-12)
    core = joined(hollow, (V / 4, F))
    assert_relative(solid(*core).volume, 7.0 + 1 / 8, 1e-12)
    with pytest.raises(InputError, match="lies within another that is wound the same way: a cavit"):
        solid(*joined((V, F), (V / 2, F)))


def test_parts_apart_and_parts_that_touch_are_a_sum():
    for away in (3.0, 1.0):
        made = solid(*joined((V, F), (V + np.array([away, 0, 0]), F)))
        assert_relative(made.volume, 16.0, 1e-12)
        assert_within(made.centre, np.array([away / 2, 0, 0]), 1e-12)


OVERLAP = {
    # The corner's common part is 0.6 x 1.6 x 3.6; the bars cross in 1 x 1 x 0.8; a half is common.
    "corner": (V + 0.4, 16 - 0.6 * 1.6 * 3.6),
    "crossing": (V[:, [2, 1, 0]] * [1, 0.5, 0.2], 8 + 4 * 1 * 0.2 - 1 * 1 * 0.2),
    "flush": (V + np.array([0.0, 0.0, 2.0]), 12.0),
}


@pytest.mark.parametrize(("other", "volume"), OVERLAP.values(), ids=OVERLAP)
def test_parts_that_overlap_are_what_they_fill_together(other, volume):
    faces = F[:, ::-1] if other is OVERLAP["crossing"][0] else F  # whose axes are swapped
    made = solid(*joined((V, F), (other, faces)), "2 closed shells of the mesh overlap")
    assert_relative(made.volume, volume, 1e-9)
    with pytest.raises(InputError, match="overlap that are wound different ways"):
        solid(*joined((V, F), (other, faces[:, ::-1])))
