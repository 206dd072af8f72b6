"""The inside of closed meshes: as files have them, and as they should not be."""

import re

import numpy as np
import pytest
import trimesh

from quasistatic_ref import InputError, scanned_body
from quasistatic_ref.optional.scans.closed import closed_mesh
from quasistatic_ref.optional.scans.solid import Solid
from tests.cases import cases
from tests.closeness import assert_relative, assert_within

BOX = trimesh.creation.box((1.0, 2.0, 4.0))
V, F = np.array(BOX.vertices), np.array(BOX.faces)


def solid(vertices, faces, *words):
    """The solid of a mesh, of which these words are noted."""
    notes = []
    mesh = closed_mesh(vertices, faces, notes)
    assert len(notes) == len(words)
    assert all(word in note for word, note in zip(words, notes, strict=True))
    return Solid.of_triangles(mesh.triangles)


def joined(*meshes):
    starts = np.cumsum([0, *(len(v) for v, _ in meshes)])
    faces = [f + start for (_, f), start in zip(meshes, starts, strict=False)]
    return np.concatenate([v for v, _ in meshes]), np.concatenate(faces)


def test_a_box_as_it_is_as_loose_triangles_and_off_by_a_bit(rng):
    loose = V[F].reshape(-1, 3)
    apart = loose * (1 + 1e-7 / 4 * rng.uniform(-1, 1, loose.shape))
    each = np.arange(36).reshape(-1, 3)
    for vertices, faces in ((V, F), (loose, each), (apart, each)):
        made = solid(vertices, faces)
        assert_relative(made.volume, 8.0, 1e-6)
        assert_within(made.centre, np.zeros(3), 1e-6)


def test_a_mesh_that_is_wound_inwards_is_turned():
    made = solid(V + 5.0, F[:, ::-1], "wound inwards")
    assert_relative(made.volume, 8.0, 1e-12)
    assert_relative(made.centre, 5.0, 1e-12)


def test_a_triangle_that_is_turned_is_turned_back():
    mixed = np.where(np.isin(np.arange(12), [0, 1, 7])[:, None], F[:, ::-1], F)
    assert_relative(solid(V, mixed, "3 triangles are wound inwards, or").volume, 8.0, 1e-12)


APART = {
    # Boxes of 8 m^3, at these places and scaled, and which are wound inwards; then the volume.
    "one of two": ([(0, 1), (10, 1)], [1], 16.0),
    "the larger one of two": ([(0, 2), (10, 1)], [0], 72.0),
    "two of three": ([(0, 1), (10, 1), (20, 1)], [0, 2], 24.0),
    "one beside a box with a cavity": ([(0, 1), (0, 0.5), (10, 1)], [1, 2], 15.0),
    "one that touches the other": ([(0, 1), (1, 1)], [1], 16.0),
}


@cases("places, inwards, volume", APART)
def test_a_part_that_is_wound_inwards_is_turned(places, inwards, volume):
    boxes = [(scale * V + [x, 0.0, 0.0], F[:, ::-1] if i in inwards else F)
             for i, (x, scale) in enumerate(places)]  # fmt: skip
    made = solid(*joined(*boxes), "12 triangles are wound inwards" if len(inwards) < 2 else "wound")
    assert_relative(made.volume, volume, 1e-12)


HOLE = r"has 3 edges, the first at \(-500, -1000, 0\) mm, of one triangle: a hole; close it"
DOUBLED = "has 3 edges, .* mm, of more than two triangles: a doubled face"


@pytest.mark.parametrize(
    ("faces", "words"),
    [
        (F[1:], HOLE),
        (np.concatenate([F, F[3:4]]), DOUBLED),
        (np.concatenate([F, F[3:4, ::-1]]), DOUBLED),
        (np.concatenate([F, F]), "has 18 edges, .* doubled face"),
    ],
)
def test_a_hole_and_a_doubled_face_are_refused_where_they_are(faces, words):
    with pytest.raises(InputError, match=words):
        closed_mesh(V, faces, [])


TETRAHEDRON = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
NOTHING = {
    "a point": (np.ones((4, 3)), TETRAHEDRON),
    "a line": (np.arange(4.0)[:, None] * [1, 1, 1], TETRAHEDRON),
    "a line far away": (1e6 + np.arange(4.0)[:, None] * [1, 2, 3], TETRAHEDRON),
    "a plane": (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]]), TETRAHEDRON),
    "triangles that are points": (np.eye(4, 3), np.repeat(np.arange(4), 3).reshape(-1, 3)),
}


@pytest.mark.parametrize(("vertices", "faces"), NOTHING.values(), ids=NOTHING)
def test_a_closed_mesh_that_encloses_nothing_is_refused(tmp_path, vertices, faces):
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    for kind in ("obj", "off", "ply", "stl"):
        mesh.export(tmp_path / f"m.{kind}")
        with pytest.raises(InputError, match="mesh: encloses nothing"):
            scanned_body(tmp_path / f"m.{kind}", mass=1.0, unit="m")


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


def test_parts_apart_and_parts_that_touch_are_a_sum():
    for away in (3.0, 1.0):
        made = solid(*joined((V, F), (V + np.array([away, 0, 0]), F)))
        assert_relative(made.volume, 16.0, 1e-12)
        assert_within(made.centre, np.array([away / 2, 0, 0]), 1e-12)


OVERLAP = {
    # The corner's common part is 0.6 x 1.6 x 3.6; a half is common.
    "corner": ((V + 0.4, F), 16, 16 - 0.6 * 1.6 * 3.6),
    "flush": ((V + np.array([0.0, 0.0, 2.0]), F), 16, 12),
    "within": ((V / 2, F), 9, 8),
    "half outside, wound inwards": ((V / 2 + [0.5, 0.0, 0.0], F[:, ::-1]), 9, 8.5),
}


@pytest.mark.parametrize(("other", "total", "filled"), OVERLAP.values(), ids=OVERLAP)
def test_shells_that_overlap_are_refused_with_their_volumes(other, total, filled):
    words = f"sum to {1e6 * total:.4g} cm^3, and together they fill {1e6 * filled:.4g} cm^3"
    with pytest.raises(InputError, match=re.escape(words)):
        closed_mesh(*joined((V, F), other), [])
