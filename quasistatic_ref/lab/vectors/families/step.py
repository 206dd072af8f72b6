"""Inputs of the layer `step`: small scenes with every kind of joint, and those without."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import UPRIGHT, at, link
from quasistatic_ref.lab.vectors.families.step_forces import force_cases
from quasistatic_ref.lab.vectors.families.step_scenes import (
    BALL,
    BRICK,
    FLOOR,
    MASS,
    TILTED,
    ball_scene,
    on,
    pair,
    scene,
)


def step_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    for cone in ("pyramid", "product", "facets-8", "frictionless"):
        why = f"a ball on the floor, pushed and spun, in the cone {cone}"
        spun = [{"body": "ball", "force": [0.4, 0.1, -1.0], "torque": [0.0, 0.0, 0.02]}]
        yield f"step/ball/{cone}", why, ball_scene([0.0, 0.0, 0.05], cone=cone, wrenches=spun)
    for name, z, why in (
        ("above", 0.0503, "a ball a third of a millimetre above the floor: it lands on it"),
        ("far", 0.5, "a ball far above the floor: it falls by h^2 g"),
        ("penetrating", 0.049, "a ball 1 mm in the floor: it is pushed out in one step"),
    ):
        yield f"step/ball/{name}", why, ball_scene([0.01, -0.02, z], quaternion=TILTED)
    yield "step/ball/no_contacts", "a ball without any pair", ball_scene([0.0, 0.0, 0.3], pairs=[])
    off = {**MASS, "com": [0.01, 0.02, -0.01]}
    why = "a ball whose centre of mass is beside its centre: it rolls"
    yield "step/ball/off_centre", why, ball_scene([0.0, 0.0, 0.05], **off)
    yield from _bricks()
    yield from _mechanisms()
    why = "a ball between two half-spaces that leave it too little room: no solution"
    yield "step/ball/infeasible", why, _wedged()
    yield from force_cases()


def _bricks() -> Iterator[Case]:
    shapes = {"floor": on(None, FLOOR), "brick": on("brick", BRICK)}
    for name, quaternion, z in (("tilted", TILTED, 0.06), ("leaning", [0.3, 0.1, 0.0, 0.9], 0.07)):
        brick = link("brick", None, "floating", **MASS)
        pairs = [{**pair("brick"), "k": 4}]
        q = [0.0, 0.0, z, *quaternion]
        why = "a brick over the floor, four corners kept, no two of which are as near"
        yield f"step/brick/{name}", why, scene([brick], shapes, q, pairs=pairs)
    rng = np.random.default_rng(81)
    points = [[round(float(x), 4) for x in row] for row in rng.uniform(-0.05, 0.05, (60, 3))]
    sampled = {
        "floor": on(None, FLOOR),
        "brick": on("brick", {"kind": "cloud", "points": points}),
    }
    for quaternion in (UPRIGHT, TILTED):
        pairs = [{**pair("brick"), "k": 5}]
        name = "upright" if quaternion is UPRIGHT else "tilted"
        q = [0.0, 0.0, 0.0495, *quaternion]
        why = "a body given by 60 random points, the five nearest to the floor"
        brick = link("brick", None, "floating", **MASS)
        yield f"step/cloud/{name}", why, scene([brick], sampled, q, pairs=pairs)


def _mechanisms() -> Iterator[Case]:
    wall = on(None, {"kind": "halfspace", "normal": [-1.0, 0.0, 0.0], "offset": -0.3})
    tip = on("tip", {"kind": "sphere", "radius": 0.02}, 0.1)
    swing = {"axis": [0.0, 1.0, 0.0], "actuated": True, **MASS}
    lower = link("tip", "upper", "revolute", placement=at(0.2, 0.0, 0.0), **swing)
    arm = [link("upper", None, "revolute", **swing), lower]
    touch = [{**pair("tip"), "alpha": "wall"}]
    shapes = {"wall": wall, "tip": tip}
    stiff = {"K_q": [[50.0, 5.0], [5.0, 20.0]], "q_bar_a": [0.5, -0.5]}
    why = "an arm of two joints presses on a wall: nothing is un-actuated"
    yield "step/arm/n_u_0", why, scene(arm, shapes, [0.6, -0.55], pairs=touch, **stiff)
    passive = [arm[0], {**arm[1], "actuated": False}]
    half = {"K_q": [[50.0]], "q_bar_a": [0.5]}
    why = "the same with a passive elbow"
    yield "step/arm/passive_elbow", why, scene(passive, shapes, [0.6, -0.55], pairs=touch, **half)
    loose = [{**body, "actuated": False} for body in arm]
    why = "the same without motors"
    yield "step/arm/n_a_0", why, scene(loose, shapes, [0.6, -0.55], pairs=touch)
    round_ = [{**arm[0], "joint": "continuous"}, {**passive[1], "joint": "continuous"}]
    q, half = [0.8, 0.6, 0.8, -0.6], {"K_q": [[50.0]], "q_bar_a": [0.96, 0.28]}
    why = "joints without end stops: cosine and sine, of length one but for rounding"
    yield "step/arm/continuous", why, scene(round_, shapes, q, pairs=touch, **half)
    pusher = link("tip", None, "planar", actuated=True, placement=at(0.0, 0.0, 0.05))
    stiff = {"K_q": np.diag([500.0, 500.0, 5.0]).tolist(), "q_bar_a": [-0.09, 0.012, 0.6, 0.8]}
    why = "a planar pusher against a ball on the floor"
    yield "step/planar/push", why, _pushed(pusher, [-0.0999, 0.01, 0.8, 0.6], stiff)
    holder = link("tip", None, "floating", actuated=True)
    target = [-0.07, 0.025, 0.095, 0.2, 0.1, -0.1, 0.95]
    stiff = {"K_q": np.diag([500.0] * 3 + [5.0] * 3).tolist(), "q_bar_a": target}
    why = "an actuated floating base against a ball on the floor"
    yield "step/floating/push", why, _pushed(holder, [-0.08, 0.03, 0.1, *TILTED], stiff)


def _pushed(pusher: Json, q_a: list[float], stiff: Json) -> Json:
    """A ball on the floor, and a pusher at q_a that touches it."""
    puck = link("ball", None, "floating", **MASS)
    shapes = {"floor": on(None, FLOOR), "tip": on("tip", BALL), "ball": on("ball", BALL)}
    pairs = [pair("ball"), {**pair("ball"), "name": "push", "alpha": "tip"}]
    q = [*q_a, 0.0, 0.0, 0.05, *UPRIGHT]
    return scene([pusher, puck], shapes, q, pairs=pairs, **stiff)


def _wedged() -> Json:
    lid = on(None, {"kind": "halfspace", "normal": [0.0, 0.0, -1.0], "offset": -0.095})
    shapes = {"floor": on(None, FLOOR), "lid": lid, "ball": on("ball", BALL)}
    pairs = [pair("ball"), {**pair("ball"), "name": "lid", "alpha": "lid"}]
    ball = link("ball", None, "floating", **MASS)
    return scene([ball], shapes, [0.0, 0.0, 0.048, *UPRIGHT], pairs=pairs)
