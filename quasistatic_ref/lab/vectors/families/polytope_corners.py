"""Degenerate pairs of balls, capsules, boxes, hulls and planes: touching, parallel, concentric."""

from __future__ import annotations

from typing import Final

from quasistatic_ref.lab.vectors.families.shapes import (
    ALONG_X,
    FLOOR,
    ON_SIDE,
    POLYHEDRON,
    TETRAHEDRON,
    Table,
    about_x,
    at,
    box,
    capsule,
    convex,
    sphere,
)

HALF: Final = box(0.5, 0.5, 0.5)
CUBE: Final = box(1.0, 1.0, 1.0)
ORIGIN: Final = at(0.0, 0.0, 0.0)
SKEW: Final = [0.1, 0.2, 0.3, 0.9]
EIGHTH: Final = [0.0, 0.0, 0.41421356, 1.0]
"""An eighth of a turn about z but for 2e-9."""

POLYTOPE_CORNERS: Final[dict[str, tuple[str, Table, Table, Table, Table]]] = {
    "spheres_concentric": (
        "two balls about one point: every n will do",
        *(sphere(0.2), ORIGIN, sphere(0.1), ORIGIN),
    ),
    "spheres_touching": (
        "two balls that touch in one point, distances 3, 4, 5",
        *(sphere(0.25), ORIGIN, sphere(0.375), at(0.375, 0.5, 0.0)),
    ),
    "spheres_tiny": (
        "balls of 0.1 mm, 1 nm apart",
        *(sphere(1e-4), ORIGIN, sphere(1e-4), at(2.00001e-4, 0.0, 0.0)),
    ),
    "spheres_unequal": (
        "radii of 1 km and 1 mm",
        *(sphere(1e3), at(0.0, 0.0, -1e3), sphere(1e-3), at(0.3, 0.4, 0.002)),
    ),
    "spheres_far": (
        "balls 10 km from the origin",
        *(sphere(0.1), at(1e4, -2e4, 5e3), sphere(0.2), at(1e4, -2e4, 5000.4)),
    ),
    "sphere_on_box_face": (
        "a ball touches the middle of a face",
        *(CUBE, ORIGIN, sphere(0.25), at(0.0, 0.0, 0.75)),
    ),
    "sphere_centre_on_face": (
        "a ball's centre in a face: n is the face's",
        *(CUBE, ORIGIN, sphere(0.25), at(0.1, 0.2, 0.5)),
    ),
    "sphere_centre_on_edge": (
        "a ball's centre on an edge: n is anything between two faces'",
        *(CUBE, ORIGIN, sphere(0.25), at(0.5, 0.2, 0.5)),
    ),
    "sphere_centre_in_middle": (
        "a ball in the middle of a cube: six ways out",
        *(CUBE, ORIGIN, sphere(0.25), ORIGIN),
    ),
    "sphere_inside_tie": (
        "a ball's centre as near to one face of a box as to another",
        *(CUBE, ORIGIN, sphere(0.25), at(0.25, 0.25, 0.125)),
    ),
    "sphere_at_corner": (
        "a ball before a cube's corner, 2 3 6 away: distance 7",
        *(CUBE, ORIGIN, sphere(0.25), at(0.75, 0.875, 1.25)),
    ),
    "sphere_on_capsule_axis": (
        "a ball's centre on a capsule's axis: n is anything at right angles to it",
        *(capsule(0.1, 1.0), ORIGIN, sphere(0.05), at(0.0, 0.0, 0.2)),
    ),
    "sphere_at_capsule_end": (
        "a ball's centre at the end of a capsule's axis",
        *(capsule(0.1, 1.0), ORIGIN, sphere(0.05), at(0.0, 0.0, 0.5)),
    ),
    "boxes_faces": (
        "two faces parallel, 0.25 m apart: the witnesses fill a rectangle",
        *(CUBE, ORIGIN, HALF, at(0.125, 0.0, 1.0)),
    ),
    "boxes_faces_touching": (
        "two faces in one plane",
        *(CUBE, ORIGIN, HALF, at(0.125, 0.0, 0.75)),
    ),
    "boxes_faces_inside": (
        "two faces parallel, 0.125 m deep",
        *(CUBE, ORIGIN, HALF, at(0.125, 0.0, 0.625)),
    ),
    "boxes_concentric": (
        "a cube in the middle of another: six ways out",
        CUBE,
        ORIGIN,
        HALF,
        ORIGIN,
    ),
    "boxes_two_ways": (
        "as deep along x as along y",
        *(CUBE, ORIGIN, HALF, at(0.625, 0.625, 0.125)),
    ),
    "boxes_edges_parallel": (
        "two parallel edges before each other",
        *(CUBE, ORIGIN, HALF, at(1.0, 0.0, 1.0)),
    ),
    "boxes_corners": (
        "two corners before each other, 2 3 6 away",
        *(CUBE, ORIGIN, HALF, at(0.75 + 0.25, 0.75 + 0.375, 0.75 + 0.75)),
    ),
    "boxes_corner_touching": (
        "two corners in one point: n is anything in a cone",
        *(CUBE, ORIGIN, HALF, at(0.75, 0.75, 0.75)),
    ),
    "boxes_edges_touching": (
        "two edges cross in one point: one n, one point",
        *(box(1.0, 1.0, 1.0), at(0.0, 0.0, 0.0, [0.0, 0.5, 0.0, 1.5])),
        *(box(1.0, 1.0, 1.0), at(0.3, 0.2, 1.4, [0.5, 0.0, 0.0, 1.5])),
    ),
    "boxes_corner_on_face": (
        "a corner before a face: unique",
        *(CUBE, ORIGIN, HALF, at(0.1, 0.05, 1.0, [0.4, 0.2, 0.1, 1.0])),
    ),
    "boxes_corner_in_face": (
        "a corner in a face, 0.01 m deep or so",
        *(CUBE, ORIGIN, HALF, at(0.1, 0.05, 0.86, [0.4, 0.2, 0.1, 1.0])),
    ),
    "boxes_nearly_parallel": (
        "two faces parallel but for 1e-6 rad",
        *(CUBE, ORIGIN, HALF, at(0.125, 0.0, 1.0, [5e-7, 3e-7, 0.0, 1.0])),
    ),
    "boxes_nearly_parallel_inside": (
        "the same in penetration",
        *(CUBE, ORIGIN, HALF, at(0.125, 0.0, 0.7, [5e-7, 3e-7, 0.0, 1.0])),
    ),
    "boxes_far": (
        "boxes 1 km from the origin, 1 mm apart",
        *(box(0.1, 0.2, 0.3), at(1e3, 5e2, -2e2, SKEW), box(0.1, 0.1, 0.1), at(1e3, 5e2, -199.7)),
    ),
    "box_plate": (
        "a plate of 10 m and 0.1 mm under a cube of 1 cm",
        *(box(10.0, 10.0, 1e-4), ORIGIN, box(0.01, 0.01, 0.01), at(3.0, 2.0, 0.01, SKEW)),
    ),
    "box_crossed": (
        "a beam through another, at an eighth of a turn: the way out is up or down",
        *(box(2.0, 0.2, 0.2), ORIGIN, box(2.0, 0.2, 0.2), at(0.0, 0.0, 0.0, EIGHTH)),
    ),
    "box_on_floor": (
        "a cube stands on the floor: four corners are as low",
        *(FLOOR, ORIGIN, CUBE, at(0.0, 0.0, 0.5)),
    ),
    "box_on_edge": (
        "a box over the floor on one edge",
        *(FLOOR, ORIGIN, box(0.2, 0.3, 0.4), at(0.0, 0.0, 0.5, [0.2, 0.0, 0.0, 1.0])),
    ),
    "floor_of_any_length": (
        "a half-space with a normal of length 7: n x <= offset is divided by it",
        *({"kind": "halfspace", "normal": [2.0, 3.0, 6.0], "offset": 1.75}, ORIGIN),
        *(sphere(0.25), at(0.5, 0.5, 1.0)),
    ),
    "floor_turned": (
        "a half-space in a frame of its own, as beta",
        *(
            convex(TETRAHEDRON),
            at(0.1, 0.2, 0.3, SKEW),
            FLOOR,
            at(0.5, 0.0, 0.0, [0.3, 0.1, 0.0, 2.0]),
        ),
    ),
    "capsules_parallel": (
        "two capsules side by side",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 0.5), at(0.5, 0.0, 0.125)),
    ),
    "capsules_nearly_parallel": (
        "two capsules side by side but for 1e-6 rad",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 0.5), at(0.5, 0.0, 0.125, about_x(1e-6))),
    ),
    "capsules_crossed": (
        "two axes at right angles, 0.5 m apart",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 1.0), at(0.5, 0.0, 0.0, ON_SIDE)),
    ),
    "capsules_through": (
        "two axes that meet: n and -n are as good",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 1.0), at(0.0, 0.1, 0.2, ON_SIDE)),
    ),
    "capsules_in_line": (
        "two capsules end to end",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 1.0), at(0.0, 0.0, 1.5)),
    ),
    "capsules_overlapping": (
        "two axes on one line, overlapping",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 1.0), at(0.0, 0.0, 0.75)),
    ),
    "capsules_grazing": (
        "two axes that pass at 1e-9 m",
        *(capsule(0.1, 1.0), ORIGIN, capsule(0.2, 1.0), at(1e-9, 0.1, 0.2, ON_SIDE)),
    ),
    "capsule_on_floor": (
        "a capsule lies on the floor",
        *(FLOOR, ORIGIN, capsule(0.125, 1.0), at(0.0, 0.0, 0.125, ALONG_X)),
    ),
    "capsule_on_box": (
        "a capsule lies on a box",
        *(CUBE, ORIGIN, capsule(0.125, 0.5), at(0.0, 0.1, 0.625, ALONG_X)),
    ),
    "capsule_axis_in_face": (
        "a capsule's axis lies in a face of a box",
        *(CUBE, ORIGIN, capsule(0.125, 0.5), at(0.0, 0.1, 0.5, ALONG_X)),
    ),
    "capsule_through_box": (
        "a capsule sticks through a plate",
        *(box(1.0, 1.0, 0.1), ORIGIN, capsule(0.05, 1.0), at(0.1, 0.2, 0.0)),
    ),
    "convex_octahedron_on_floor": (
        "an octahedron stands on its tip",
        *(
            FLOOR,
            ORIGIN,
            convex(
                [
                    *([0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.5, 0.0]),
                    *([0.0, -0.5, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, -0.5]),
                ]
            ),
        ),
        at(0.0, 0.0, 0.5),
    ),
    "convex_cube": (
        "a cube as eight vertices, one in the middle of a face, on a box: as the box's own",
        *(CUBE, ORIGIN),
        convex(
            [
                *(
                    [0.25, 0.25, 0.25],
                    [0.25, 0.25, -0.25],
                    [0.25, -0.25, 0.25],
                    [0.25, -0.25, -0.25],
                ),
                *([-0.25, 0.25, 0.25], [-0.25, 0.25, -0.25], [-0.25, -0.25, 0.25]),
                *([-0.25, -0.25, -0.25], [0.0, 0.0, 0.25]),
            ]
        ),
        at(0.125, 0.0, 1.0),
    ),
    "convex_tetrahedra": (
        "a tetrahedron's tip in another's face",
        *(convex(TETRAHEDRON), ORIGIN, convex(TETRAHEDRON), at(0.0, 0.05, -0.29, SKEW)),
    ),
    "convex_on_capsule": (
        "a polyhedron beside a capsule, edge against side",
        *(
            convex(POLYHEDRON),
            at(0.0, 0.0, 0.0, SKEW),
            capsule(0.05, 2.0),
            at(0.5, 0.1, 0.0, ON_SIDE),
        ),
    ),
}
"""Name, provenance, alpha, its pose, beta, its pose."""
