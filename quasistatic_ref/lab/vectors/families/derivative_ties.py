"""Kinks of the layer `derivative` that come from where the contacts are."""

from collections.abc import Iterator

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families import derivative_kinks as kinks
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import UPRIGHT, at
from quasistatic_ref.lab.vectors.families.step_scenes import FLOOR

SIDEWAYS = [1.0, 0.5, -4.0]
"""A force that slides [N]."""


def tie_cases() -> list[tuple[str, Iterator[Case]]]:
    """Kind, and name, provenance and input of its cases."""
    return [("selection", _selection()), ("feature", _feature()), ("tangents", _tangents())]


def _selection() -> Iterator[Case]:
    low = [[0.0625, 0.0, -0.0625], [-0.0625, 0.03125, -0.0625], [0.0, -0.0625, -0.0625]]
    high = [[0.0, 0.0, 0.0625], [0.03125, 0.0, -0.03125]]
    for name, points, k in (
        ("two", [low[0], low[1], *high], 1),
        ("two_late", [high[0], low[2], high[1], low[0]], 1),
        ("three_one", [*low, *high], 1),
        ("three_two", [high[0], *low], 2),
    ):
        cloud = {"kind": "cloud", "points": points}
        depth = -min(point[2] for point in points)
        for gap in (0.0, -0.0009765625):
            table = kinks.free(cloud, [0.0, 0.0, depth + gap])
            pressed = kinks.onto(table, "floor", FLOOR, k=k)
            why = f"a cloud over the floor, of which {k} are kept where more are as near"
            where = "on" if gap == 0 else "in"
            yield f"cloud_{name}_{where}", why, kinks.pushed(pressed, SIDEWAYS)
    for k in (2, 3):
        box = kinks.onto(kinks.free(kinks.SQUARE, [0.0, 0.0, 0.0625]), "floor", FLOOR, k=k)
        why = f"a box flat on the floor, of whose four corners {k} are kept"
        yield f"box_{k}", why, kinks.pushed(box, SIDEWAYS, [0.0625, 0.0, 0.0])


def _feature() -> Iterator[Case]:
    down, lying = at(0.0, 0.0, -0.0625), [0.0, 1.0, 0.0, 1.0]
    edge, corner = [0.125, 0.03125, kinks.R], [0.125, 0.125, kinks.R]
    can = {"kind": "cylinder", "radius": 0.125, "length": 0.125}
    for name, shape, xyz, under in (
        ("ball_edge", kinks.BALL, edge, kinks.SQUARE),
        ("ball_corner", kinks.BALL, corner, kinks.SQUARE),
        ("ball_rim", kinks.BALL, [0.125, 0.0, kinks.R], can),
        ("point_edge", {"kind": "cloud", "points": [[0.0, 0.0, 0.0]]}, [0.125, 0.0, 0.015625],
         kinks.SQUARE),
        ("point_inside", {"kind": "cloud", "points": [[0.0, 0.0, 0.0]]}, [0.109375, 0.0, -0.015625],
         kinks.SQUARE),
    ):  # fmt: skip
        why = f"a {shape['kind']} where the closest point of a {under['kind']} leaves its face"
        table = kinks.onto(kinks.free(shape, xyz), "ground", under, down)
        yield name, why, kinks.pushed(table, [4.0, 0.5, -16.0])
    rod = {"kind": "capsule", "radius": kinks.R, "length": 0.25}
    prism = [[x, y, z] for x in (-0.125, 0.125) for y, z in ((0, -0.0625), (0.125, 0), (-0.125, 0))]
    for name, shape, xyz, quaternion in (
        ("box_flat", kinks.SQUARE, [0.0, 0.0, 0.0625], UPRIGHT),
        ("capsule_flat", rod, [0.0, 0.0, kinks.R], lying),
        ("can_upright", can, [0.0, 0.0, 0.0625], UPRIGHT),
        ("can_lying", can, [0.0, 0.0, 0.125], lying),
        ("hull_edge", {"kind": "convex", "vertices": [list(map(float, x)) for x in prism]},
         [0.0, 0.0, 0.0625], UPRIGHT),
    ):  # fmt: skip
        why = f"a {shape['kind']} flat on the floor, with one contact: any of many points"
        table = kinks.onto(kinks.free(shape, xyz, quaternion), "floor", FLOOR)
        yield name, why, kinks.pushed(table, SIDEWAYS, [0.03125, 0.0625, 0.0])
    table = kinks.onto(kinks.free(rod, [0.0, 0.0, 2 * kinks.R], lying), "rod", rod,
                       {**at(0.0, 0.0, 0.0), "quaternion": lying})  # fmt: skip
    yield "rods", "two parallel capsules", kinks.pushed(table, SIDEWAYS, [0.03125, 0.0625, 0.0])
    table = kinks.onto(kinks.free(kinks.SQUARE, [0.0, 0.0, 0.125]), "box", kinks.SQUARE)
    yield "boxes", "a box flat on a box, one contact", kinks.pushed(table, SIDEWAYS, [0.03125] * 3)


def _tangents() -> Iterator[Case]:
    for name, way, cone in (
        ("xy", [1.0, 1.0, 2.0], "pyramid"),
        ("xy_mirrored", [1.0, -1.0, 3.0], "pyramid"),
        ("xz", [1.0, 2.0, 1.0], "pyramid"),
        ("yz", [3.0, 1.0, -1.0], "pyramid"),
        ("xyz", [1.0, 1.0, 1.0], "pyramid"),
        ("product", [1.0, 1.0, 2.0], "product"),
        ("facets", [1.0, 1.0, 3.0], "facets-6"),
        ("hexagon", [0.0, 0.0, 1.0], "facets-6"),
    ):
        # Balls of the same size as far apart as `way`, of which the sizes follow.
        length = sum(x * x for x in way) ** 0.5
        radius = 0.03125 * length / 2
        table = kinks.free(
            {"kind": "sphere", "radius": radius}, [0.03125 * x for x in way], cone=cone
        )
        whole: Json = kinks.onto(table, "ball", {"kind": "sphere", "radius": radius}, mu_v=0.125)
        why = f"two balls whose normal is along {way}: two axes are as far from it"
        force = [-16 * x + y for x, y in zip(way, (24.0, 3.0, -16.0), strict=True)]
        yield name, why, kinks.pushed(whole, force, [0.03125, -0.0625, 0.015625])
