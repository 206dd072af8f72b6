"""Faces with notches and holes cut open: their triangles fill them, and nothing beside them."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quasistatic_ref as qr
from quasistatic_ref.optional.mesh_formats.polygons import fans_of_faces, triangles_of_faces
from tests.closeness import assert_relative, assert_same
from tests.made import loaded_mesh

L = [(0, 0), (60, 0), (60, 18), (18, 18), (18, 60), (0, 60)]
DART = [(0, 0), (20, 30), (0, 60), (8, 30)]
RING = [(0, 0), (60, 0), (60, 60), (0, 60)], [(20, 20), (20, 50), (30, 50), (30, 20)]
"""An outline, and that of a hole, the other way around [mm]."""
CUT_OPEN = [*RING[0], RING[0][0], *RING[1], RING[1][0]]
OUTLINES = {
    "L": (L, 60 * 18 + 42 * 18),
    "dart": (DART, 60 * 12 / 2),
    "ring": (CUT_OPEN, 60 * 60 - 10 * 30),
}
"""Corners of a face [mm], and its area [mm^2]."""


def skyline(rng):
    """The outline of up to five towers beside each other, and its area."""
    heights = rng.integers(1, 6, rng.integers(2, 6)).tolist()
    tops = [(x + 1 - back, h) for x, h in reversed([*enumerate(heights)]) for back in (0, 1)]
    corners = [(0, 0), (len(heights), 0), *tops]
    return [b for a, b in pairwise([corners[-1], *corners]) if a != b], sum(heights)


def frame(rng):
    """The outline of a plate with a hole, which is cut open, on a line of its sides or not."""
    width, height = rng.integers(3, 8, 2).tolist()
    x, y = rng.integers(1, [width - 1, height - 1]).tolist()
    right, top = rng.integers([x + 1, y + 1], [width, height]).tolist()
    hole = [(x, y), (x, top), (right, top), (right, y)]
    before, after = [(0, 0)], [(width, 0), (width, height), (0, height)]
    match rng.integers(3):
        case 0:
            before.append((x, 0))
        case 1:
            before, after = [*before, *after, (0, y)], []
    area = width * height - (right - x) * (top - y)
    return [*before, *hole, hole[0], before[-1], *after], area


def areas_of(corners, triangles):
    """Areas of triangles in a plane, below 0 where they are wound the other way."""
    a, b, c = np.moveaxis(np.array(corners, float)[triangles], 1, 0)
    return np.linalg.det(np.stack([b - a, c - a], axis=1)) / 2


@pytest.mark.parametrize("drawn", [skyline, frame])
def test_a_face_of_up_to_twelve_corners_is_filled_and_nothing_else(drawn, rng):
    """Triangles that are all wound as the face, with its area, lie side by side in it."""
    for _ in range(150):
        corners, area = drawn(rng)
        assert len(corners) <= 12
        turn = Rotation.random(rng=rng)
        flat = np.pad(np.array(corners, float), [(0, 0), (0, 1)])
        for places in (flat, turn.apply(0.01 * flat).round(6)):
            for first in range(len(corners)):
                numbers = np.roll(np.arange(len(corners)), first)
                triangles = triangles_of_faces(places, numbers, np.array([len(corners)]))
                assert triangles.shape == (len(corners) - 2, 3)
                each = areas_of(corners, triangles)
                assert each.min() > -1e-3  # what six digits leave of three corners in a line
                assert each.sum() == pytest.approx(area, rel=1e-12)


def prism(kind, outline, first, height=30):
    """A prism in one of the formats of faces [mm]."""
    n = len(outline)
    corners = [(x, y, z) for z in (0, height) for x, y in outline]
    ring = [*range(first, n), *range(first)]
    faces = [[i + n for i in ring], ring[::-1]]
    faces += [[i, (i + 1) % n, (i + 1) % n + n, i + n] for i in range(n)]
    points = "".join("{} {} {}\n".format(*corner) for corner in corners)
    lists = "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
    if kind == "obj":
        lines = ["v {} {} {}\n".format(*corner) for corner in corners]
        return "".join([*lines, *(f"f {' '.join(str(i + 1) for i in face)}\n" for face in faces)])
    if kind == "off":
        return f"OFF\n{2 * n} {len(faces)} 0\n{points}{lists}"
    if kind == "ply":
        return (
            f"ply\nformat ascii 1.0\nelement vertex {2 * n}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\n"
            f"end_header\n{points}{lists}"
        )
    counts = " ".join(str(len(face)) for face in faces)
    indices = [" ".join(f"{i} 0" for i in face) for face in faces]
    polygons = f'<polygons count="{len(faces)}">INPUTS<p>{"</p><p>".join(indices)}</p></polygons>'
    polylist = (
        f'<polylist count="{len(faces)}">INPUTS<vcount>{counts}</vcount><p>{" ".join(indices)}</p>'
        "</polylist>"
    )
    inputs = '<input semantic="VERTEX" source="#v" offset="0"/>'
    inputs += '<input semantic="NORMAL" source="#s" offset="1"/>'
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return (
        '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
        '<unit meter="1"/></asset><library_geometries><geometry id="g"><mesh><source id="s">'
        f'<float_array id="a" count="{6 * n}">{points}</float_array><technique_common>'
        f'<accessor source="#a" count="{2 * n}" stride="3">{axes}</accessor></technique_common>'
        '</source><vertices id="v"><input semantic="POSITION" source="#s"/></vertices>'
        f"{(polygons if kind == 'polygons' else polylist).replace('INPUTS', inputs)}"
        '</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="sc"><node>'
        '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>'
        '<instance_visual_scene url="#sc"/></scene></COLLADA>'
    )


@pytest.mark.parametrize("outline", OUTLINES)
@pytest.mark.parametrize("kind", ["obj", "off", "ply", "polylist", "polygons"])
def test_a_prism_has_its_area_and_volume_from_every_first_corner(tmp_path, kind, outline):
    corners, area = OUTLINES[outline]
    sides = np.linalg.norm(np.diff([*corners, corners[0]], axis=0), axis=1)
    path = tmp_path / (f"a.{kind}" if len(kind) == 3 else f"{kind}.dae")
    for first in range(len(corners)):
        path.write_text(prism(kind, corners, first))
        mesh = loaded_mesh(path)
        a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
        surface = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        assert_relative(surface, 2 * area + 30 * sides.sum(), 1e-6)
        assert_relative(np.vecdot(a, np.cross(b, c)).sum() / 6, 30 * area, 1e-6)


@pytest.mark.parametrize("kind", ["obj", "polylist"])
def test_no_point_of_an_angle_is_in_the_air(tmp_path, kind):
    path = tmp_path / f"a.{'dae' if kind == 'polylist' else kind}"
    path.write_text(prism(kind, L, 0))
    body = qr.scanned_body(path, density=1000.0, unit="mm", points=400)
    x, y, _ = 1e3 * body.points.T
    assert np.minimum(x, y).max() < 18 + 1e-6
    assert body.mass == pytest.approx(30e-6 * OUTLINES["L"][1], rel=1e-6)


def test_a_nut_with_holes_cut_open_is_a_closed_mesh(tmp_path):
    """A hexagon with a hole of 12 corners; its cut is inside of the material."""
    angles = np.arange(6) * np.pi / 3
    hexagon = 15 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    angles = -np.arange(12) * np.pi / 6
    hole = 8 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    outline = np.concatenate([hexagon, hexagon[:1], hole, hole[:1]]).tolist()
    text = prism("obj", outline, 5, 12)
    n = len(outline)
    cut = [f"f {i + 1} {(i + 1) % n + 1} {(i + 1) % n + n + 1} {i + n + 1}\n" for i in (6, n - 1)]
    for side in cut:  # through the material, forth and back
        assert side in text
        text = text.replace(side, "")
    (tmp_path / "nut.obj").write_text(text)
    area = 3 * np.sqrt(3) / 2 * 15**2 - 6 * 8**2 * np.sin(np.pi / 6)
    made = qr.scanned_body(tmp_path / "nut.obj", density=1000.0, unit="mm")
    assert made.mass == pytest.approx(12e-6 * area, rel=1e-12)


def test_convex_faces_keep_their_fans(rng):
    """As many corners as 3 to 9, some of them in a line, in any plane, of 32 bits."""
    sizes = rng.integers(3, 10, 300)
    faces = []
    for size in sizes.tolist():
        angles = np.sort(rng.uniform(0, 2 * np.pi, size))
        circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(size)], axis=1)
        circle[1] = (circle[0] + circle[2]) / 2
        faces.append(Rotation.random(rng=rng).apply(circle).astype(np.float32))
    corners = np.arange(sizes.sum())
    vertices = np.concatenate(faces).astype(float)
    assert_same(triangles_of_faces(vertices, corners, sizes), fans_of_faces(corners, sizes))
