"""Inputs of the layer `derivative` at which q+ has none: one kink each, exact in float64.

Lengths, masses and forces are sums of few powers of two, so that ties and limits of friction are
ties without rounding: in units of N = m h^2 g and the like.
"""

from collections.abc import Iterator
from typing import Any, Final

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.derivative_ties import tie_cases
from quasistatic_ref.lab.vectors.families.mechanisms import ORIGIN, UPRIGHT, at, link
from quasistatic_ref.lab.vectors.families.step_scenes import FLOOR, on, scene

H: Final = 0.125
G: Final = [0.0, 0.0, -8.0]
MASS: Final[Json] = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.0078125, 0.0, 0.0], [0.0, 0.01171875, 0.0], [0.0, 0.0, 0.015625]],
}
WEIGHT: Final = 4.0
"""0.5 kg times 8 m/s^2 [N]."""
R: Final = 0.0625
BALL: Final[Json] = {"kind": "sphere", "radius": R}
SQUARE: Final[Json] = {"kind": "box", "size": [0.25, 0.25, 0.125]}
"""Its faces at +-0.125, +-0.125, +-0.0625."""


def kink_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    for kind, cases in (
        ("row", _rows()),
        ("touching", _touching()),
        ("multipliers", _multipliers()),
        *tie_cases(),
    ):
        for name, why, table in cases:
            yield f"derivative/kink/{kind}/{name}", why, table


def free(shape: Json, xyz: list[float], quaternion: list[float] = UPRIGHT, **more: Any) -> Json:
    """A floating body with one shape, nothing else yet."""
    body = link("body", None, "floating", **MASS)
    given = {"h": H, "gravity": G, "pairs": [], **more}
    return scene([body], {"body": on("body", shape)}, [*xyz, *quaternion], **given)


def onto(table: Json, name: str, shape: Json, pose: Json = ORIGIN, **more: Any) -> Json:
    """The same with a shape of the world, and the pair of that and the body's."""
    friction = {"mu_v": 0.5, "mu_omega": 0.03125, "rows": 6, "k": 1, **more}
    pair = {"name": name, "alpha": name, "beta": "body", **friction}
    fixed = {"body": None, "pose": pose, "shape": shape}
    shapes = {**table["shapes"], name: fixed}
    return {**table, "shapes": shapes, "pairs": [*table["pairs"], pair]}


def pushed(table: Json, force: list[float], torque: list[float] | None = None) -> Json:
    """The same with a wrench on the body.

    Parameters
    ----------
    table : dict
    force, torque : list of float
        World frame, shape (3,) [N, N m].
    """
    wrench = {"body": "body", "force": force, "torque": torque or [0.0, 0.0, 0.0]}
    return {**table, "wrenches": [wrench]}


def _rows() -> Iterator[Case]:
    for cone in ("pyramid", "product", "frictionless"):
        still = onto(free(BALL, [0.0, 0.0, R], cone=cone), "floor", FLOOR)
        why = f"a weightless ball that just touches the floor, in the cone {cone}"
        yield f"weightless_{cone}", why, {**still, "gravity": [0.0, 0.0, 0.0]}
        why = f"a ball that falls by h^2 g and just reaches the floor, in the cone {cone}"
        landing = onto(free(BALL, [0.0, 0.0, R + 0.125], cone=cone), "floor", FLOOR)
        yield f"landing_{cone}", why, landing
    wall = {"kind": "halfspace", "normal": [-1.0, 0.0, 0.0], "offset": -R}
    beside = onto(onto(free(BALL, [0.0, 0.0, R]), "floor", FLOOR), "wall", wall)
    yield "beside", "a ball on the floor that just touches a wall", beside
    four = {**beside, "pairs": [{**pair, "rows": 4} for pair in beside["pairs"]]}
    yield "beside_4", "the same without torsion", four
    for name, mu, share in (
        ("limit_x", 0.5, [0.5, 0.0]),
        ("limit_y", 0.25, [0.0, 0.25]),
        ("limit_between", 0.5, [0.25, -0.25]),
        ("limit_steep", 1.0, [-0.75, 0.25]),
    ):
        why = "a point that slides without turning, pushed with all the friction that there is"
        yield name, why, _slider(mu, [WEIGHT * x for x in share])
    spun = pushed(onto(free(BALL, [0.0, 0.0, R]), "floor", FLOOR), [0.0] * 3, [0.0, 0.0, 0.125])
    yield "limit_spin", "a ball that is twisted with mu_omega times its weight", spun
    why = "the same the other way round, with half the friction along the floor"
    yield "limit_spin_back", why, pushed(spun, [0.0] * 3, [0.0, 0.0, -0.125])


def _slider(mu: float, force: list[float]) -> Json:
    """A point with three prismatic joints on the floor; its links have masses of their own."""
    axes = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "body": [0.0, 0.0, 1.0]}
    names = [None, *axes]
    chain = [
        link(name, names[i], "prismatic", axis=axis, **MASS)
        for i, (name, axis) in enumerate(axes.items())
    ]
    point = {"kind": "sphere", "radius": R}
    table = scene(chain, {"body": on("body", point)}, [0.0, 0.0, R], h=H, gravity=G, pairs=[])
    return pushed(onto(table, "floor", FLOOR, mu_v=mu), [*force, 0.0])


def _touching() -> Iterator[Case]:
    """Tips and rims on edges: at distance 0 many directions are normals of both."""
    lying, tip = [0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]
    top = at(0.0, 0.0, -0.0625)
    can = {"kind": "cylinder", "radius": R, "length": 0.125}
    hat = {"kind": "cone", "radius": R, "length": 0.125}
    corners = [[x, y, z] for x in (-0.125, 0.125) for y in (-0.25, 0.25) for z in (-0.0625, 0.0625)]
    hull = {"kind": "convex", "vertices": corners}
    for name, shape, xyz, quaternion, under in (
        ("cone_edge_box", hat, [0.125, 0.015625, 0.0625], tip, SQUARE),
        ("cone_corner_box", hat, [0.125, 0.125, 0.0625], tip, SQUARE),
        ("cone_edge_hull", hat, [0.125, 0.015625, 0.0625], tip, hull),
        ("cone_corner_hull", hat, [-0.125, 0.25, 0.0625], tip, hull),
        ("cone_rim", hat, [0.0625, 0.0, 0.0625], tip, can),
        ("rim_edge_box", can, [0.1875, 0.03125, R], lying, SQUARE),
        ("rim_edge_hull", can, [-0.1875, 0.03125, R], lying, hull),
    ):
        why = f"a {shape['kind']} that just touches an edge of a {under['kind']}"
        table = onto(free(shape, xyz, quaternion), "ground", under, top)
        yield name, why, pushed(table, [0.5, 0.25, -4.0])


def _multipliers() -> Iterator[Case]:
    """Three points in a row on three balls: dependent rows that a shift makes contradict."""
    for number, (radii, push, cone) in enumerate(
        (
            ([0.0625, 0.125, 0.0625], 1.0, "frictionless"),
            ([0.25, 0.0625, 0.25], 2.0, "frictionless"),
            ([0.125, 0.125, 0.0625], -1.0, "frictionless"),
            ([0.0625, 0.25, 0.25], -2.0, "frictionless"),
            ([0.0625, 0.125, 0.0625], 3.0, "pyramid"),
            ([0.25, 0.0625, 0.125], -3.0, "pyramid"),
        )
    ):
        why = f"a bar on three balls of the radii {radii}, pushed along, in the cone {cone}"
        yield f"bar_{number}", why, _bar(radii, push, cone)


def _bar(radii: list[float], push: float, cone: str) -> Json:
    """A planar body with three points at x = -1/4, 0, 1/4, each on a ball below it."""
    body = link("body", None, "planar", **MASS)
    table = scene([body], {}, [0.0, 0.0, 1.0, 0.0], h=H, gravity=[0.0, -8.0, 0.0], cone=cone)
    pairs, shapes = [], {}
    for k, radius in enumerate(radii):
        x = (k - 1) * 0.25
        point = {"kind": "cloud", "points": [[x, 0.0, 0.0]]}
        shapes[f"point{k}"] = {"body": "body", "pose": ORIGIN, "shape": point}
        ball = {"kind": "sphere", "radius": radius}
        shapes[f"ball{k}"] = {"body": None, "pose": at(x, -radius, 0.0), "shape": ball}
        one = {"name": f"pair{k}", "alpha": f"ball{k}", "beta": f"point{k}", "rows": 4, "k": 1}
        pairs.append({**one, "mu_v": 0.25, "mu_omega": 0.03125})
    return pushed({**table, "pairs": pairs, "shapes": shapes}, [push, 0.0, 0.0])
