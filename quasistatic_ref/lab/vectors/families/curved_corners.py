"""Degenerate pairs with a cylinder, cone or ellipsoid: standing, lying, on rim, axis or tip."""

from __future__ import annotations

from typing import Final

from quasistatic_ref.lab.vectors.families.polytope_corners import CUBE, HALF, ORIGIN
from quasistatic_ref.lab.vectors.families.shapes import (
    ALONG_X,
    FLOOR,
    ON_SIDE,
    Table,
    about_x,
    at,
    capsule,
    cloud,
    cone,
    cylinder,
    ellipsoid,
    sphere,
)

CURVED_CORNERS: Final[dict[str, tuple[str, Table, Table, Table, Table]]] = {
    "cylinder_standing": (
        "a cylinder stands on the floor",
        *(FLOOR, ORIGIN, cylinder(0.25, 1.0), at(0.0, 0.0, 0.5)),
    ),
    "cylinder_lying": (
        "a cylinder lies on the floor",
        *(FLOOR, ORIGIN, cylinder(0.25, 1.0), at(0.0, 0.0, 0.25, ALONG_X)),
    ),
    "cylinder_nearly_standing": (
        "a cylinder that leans by 1e-7 rad: one point of the rim, wherever rounding lets it",
        *(FLOOR, ORIGIN, cylinder(0.25, 1.0), at(0.0, 0.0, 0.5, about_x(1e-7))),
    ),
    "cylinder_leaning": (
        "a cylinder on its rim",
        *(FLOOR, ORIGIN, cylinder(0.25, 1.0), at(0.0, 0.0, 0.6, [0.3, 0.1, 0.0, 1.0])),
    ),
    "cylinder_ball_at_rim": (
        "a ball before the rim of a cylinder, 3 4 away",
        *(cylinder(0.25, 1.0), ORIGIN, sphere(0.125), at(0.625, 0.0, 1.0)),
    ),
    "cylinder_ball_on_axis": (
        "a ball's centre on the axis of a long cylinder: every way out to the side",
        *(cylinder(0.25, 1.0), ORIGIN, sphere(0.125), at(0.0, 0.0, 0.1)),
    ),
    "cylinder_ball_on_cap": (
        "a ball on the middle of a cap: n is unique although the radius has no direction",
        *(cylinder(0.25, 1.0), ORIGIN, sphere(0.125), at(0.0, 0.0, 0.625)),
    ),
    "cylinder_points": (
        "points on the rim, the side, a cap, the axis and as deep from side as from cap",
        *(cylinder(0.5, 2.0), ORIGIN),
        cloud(
            [
                *([0.5, 0.0, 1.0], [0.3, 0.4, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]),
                *([0.25, 0.0, 0.75], [0.0, 0.0, 0.75], [0.375, 0.0, 0.0]),
            ]
        ),
        ORIGIN,
    ),
    "cylinder_on_box": (
        "a cylinder stands over a box: the witnesses fill its cap",
        *(CUBE, ORIGIN, cylinder(0.25, 1.0), at(0.125, 0.0, 1.125)),
    ),
    "cylinder_beside_box": (
        "a cylinder lies over a box: the witnesses fill a segment",
        *(CUBE, ORIGIN, cylinder(0.25, 0.5), at(0.125, 0.0, 1.0, ALONG_X)),
    ),
    "cylinder_over_edge": (
        "a box's edge across a cylinder's side: unique",
        *(cylinder(0.25, 1.0), ORIGIN, HALF, at(0.75, 0.0, 0.0, [0.3, 0.0, 0.4, 1.0])),
    ),
    "cylinders_parallel": (
        "two cylinders side by side",
        *(cylinder(0.25, 1.0), ORIGIN, cylinder(0.125, 1.0), at(0.5, 0.0, 0.25)),
    ),
    "cylinders_crossed": (
        "two cylinders whose sides cross: unique",
        *(cylinder(0.25, 1.0), ORIGIN, cylinder(0.125, 1.0), at(0.5, 0.0, 0.0, ON_SIDE)),
    ),
    "cylinders_stacked": (
        "one cylinder over another: the witnesses fill a disc",
        *(cylinder(0.25, 1.0), ORIGIN, cylinder(0.125, 1.0), at(0.125, 0.0, 1.25)),
    ),
    "cylinders_rims": (
        "two rims before each other, askew",
        *(
            cylinder(0.25, 1.0),
            ORIGIN,
            cylinder(0.125, 0.5),
            at(0.7, 0.2, 1.2, [0.2, -0.3, 0.1, 1.0]),
        ),
    ),
    "cylinder_on_side_of_other": (
        "a rim before another's side",
        *(
            cylinder(0.25, 1.0),
            ORIGIN,
            cylinder(0.125, 1.0),
            at(0.8, 0.0, 0.2, [0.1, 0.5, 0.0, 1.0]),
        ),
    ),
    "cylinder_in_capsule": (
        "a capsule's ball reaches a cylinder that its axis does not: a depth with a closed form",
        *(
            cylinder(0.25, 1.0),
            ORIGIN,
            capsule(0.125, 1.0),
            at(0.3, 0.0, 0.1, [0.3, 0.0, 0.1, 1.0]),
        ),
    ),
    "cone_on_tip": (
        "a cone on its tip over the floor",
        *(FLOOR, ORIGIN, cone(0.25, 1.0), at(0.0, 0.0, 0.75, [1.0, 0.0, 0.0, 0.0])),
    ),
    "cone_standing": (
        "a cone stands on the floor",
        *(FLOOR, ORIGIN, cone(0.25, 1.0), at(0.0, 0.0, 0.5)),
    ),
    "cone_points": (
        "points on the tip, the rim, the axis, beyond base and tip, in the side",
        *(cone(0.75, 2.0), ORIGIN),
        cloud(
            [
                *([0.0, 0.0, 1.0], [0.75, 0.0, -1.0], [0.0, 0.0, 0.0], [0.0, 0.0, -1.5]),
                *([0.0, 0.0, 1.5], [0.375, 0.0, 0.0], [1.0, 0.5, -0.5], [0.1, 0.2, -0.9]),
                *([2.0, 0.0, -1.0], [0.2, 0.0, 1.1]),
            ]
        ),
        ORIGIN,
    ),
    "ellipsoid_centre": (
        "a ball in the middle of an ellipsoid: two ways out along the least axis",
        *(ellipsoid(0.25, 0.5, 1.0), ORIGIN, sphere(0.125), ORIGIN),
    ),
    "ellipsoid_points": (
        "points on its surface, on and beyond the plane where two ways out are as short",
        *(ellipsoid(0.25, 0.5, 1.0), ORIGIN),
        cloud(
            [
                *([0.25, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.1, 0.2], [0.0, 0.45, 0.0]),
                *([0.0, 0.0, 0.96], [1e-9, 0.1, 0.2], [0.5, 0.5, 0.5], [0.0, 0.0, 2.0]),
            ]
        ),
        ORIGIN,
    ),
    "ellipsoid_round": (
        "an ellipsoid that is a ball",
        *(ellipsoid(0.25, 0.25, 0.25), ORIGIN, sphere(0.125), at(0.2, -0.3, 0.6)),
    ),
    "ellipsoid_needle": (
        "an ellipsoid a thousand times as long as thick",
        *(ellipsoid(1e-3, 2e-3, 1.0), ORIGIN, sphere(0.01), at(0.02, 0.01, 0.7)),
    ),
}
"""Name, provenance, alpha, its pose, beta, its pose."""
