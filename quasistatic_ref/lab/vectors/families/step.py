"""Inputs of the layer `step`: small scenes with every kind of joint, and those without."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import UPRIGHT, at, link

GRAVITY = [0.0, 0.0, -9.81]
BALL: Json = {"kind": "sphere", "radius": 0.05}
BRICK: Json = {"kind": "box", "size": [0.1, 0.08, 0.06]}
FLOOR: Json = {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
MASS: Json = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.001, 0.0, 0.0], [0.0, 0.0012, 0.0], [0.0, 0.0, 0.0014]],
}
TILTED = [0.1, -0.05, 0.2, 0.97]


def step_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    for cone in ("pyramid", "product", "facets-8", "frictionless"):
        why = f"a ball on the floor, pushed and spun, in the cone {cone}"
        spun = [{"body": "ball", "force": [0.4, 0.1, -1.0], "torque": [0.0, 0.0, 0.02]}]
        yield f"step/ball/{cone}", why, _ball([0.0, 0.0, 0.05], cone=cone, wrenches=spun)
    for name, z, why in (
        ("above", 0.0503, "a ball a third of a millimetre above the floor: it lands on it"),
        ("far", 0.5, "a ball far above the floor: it falls by h^2 g"),
        ("penetrating", 0.049, "a ball 1 mm in the floor: it is pushed out in one step"),
    ):
        yield f"step/ball/{name}", why, _ball([0.01, -0.02, z], quaternion=TILTED)
    yield "step/ball/no_contacts", "a ball without any pair", _ball([0.0, 0.0, 0.3], pairs=[])
    off = {**MASS, "com": [0.01, 0.02, -0.01]}
    why = "a ball whose centre of mass is beside its centre: it rolls"
    yield "step/ball/off_centre", why, _ball([0.0, 0.0, 0.05], **off)
    yield from _bricks()
    yield from _mechanisms()
    why = "a ball between two half-spaces that leave it too little room: no solution"
    yield "step/ball/infeasible", why, _wedged()


def _ball(xyz: list[float], *, quaternion: Any = UPRIGHT, **more: Any) -> Json:
    body = {key: more.pop(key) for key in ("mass", "com", "inertia") if key in more}
    ball = link("ball", None, "floating", **{**MASS, **body})
    shapes = {"floor": _on(None, FLOOR), "ball": _on("ball", BALL)}
    return _scene([ball], shapes, [*xyz, *quaternion], **{"pairs": [_pair("ball")], **more})


def _bricks() -> Iterator[Case]:
    shapes = {"floor": _on(None, FLOOR), "brick": _on("brick", BRICK)}
    for name, quaternion, z in (("tilted", TILTED, 0.06), ("leaning", [0.3, 0.1, 0.0, 0.9], 0.07)):
        brick = link("brick", None, "floating", **MASS)
        pairs = [{**_pair("brick"), "k": 4}]
        q = [0.0, 0.0, z, *quaternion]
        why = "a brick over the floor, four corners kept, no two of which are as near"
        yield f"step/brick/{name}", why, _scene([brick], shapes, q, pairs=pairs)
    rng = np.random.default_rng(81)
    points = [[round(float(x), 4) for x in row] for row in rng.uniform(-0.05, 0.05, (60, 3))]
    sampled = {
        "floor": _on(None, FLOOR),
        "brick": _on("brick", {"kind": "cloud", "points": points}),
    }
    for quaternion in (UPRIGHT, TILTED):
        pairs = [{**_pair("brick"), "k": 5}]
        name = "upright" if quaternion is UPRIGHT else "tilted"
        q = [0.0, 0.0, 0.0495, *quaternion]
        why = "a body given by 60 random points, the five nearest to the floor"
        brick = link("brick", None, "floating", **MASS)
        yield f"step/cloud/{name}", why, _scene([brick], sampled, q, pairs=pairs)


def _mechanisms() -> Iterator[Case]:
    wall = _on(None, {"kind": "halfspace", "normal": [-1.0, 0.0, 0.0], "offset": -0.3})
    tip = _on("tip", {"kind": "sphere", "radius": 0.02}, 0.1)
    swing = {"axis": [0.0, 1.0, 0.0], "actuated": True, **MASS}
    lower = link("tip", "upper", "revolute", placement=at(0.2, 0.0, 0.0), **swing)
    arm = [link("upper", None, "revolute", **swing), lower]
    touch = [{**_pair("tip"), "alpha": "wall"}]
    shapes = {"wall": wall, "tip": tip}
    stiff = {"K_q": [[50.0, 5.0], [5.0, 20.0]], "q_bar_a": [0.5, -0.5]}
    why = "an arm of two joints presses on a wall: nothing is un-actuated"
    yield "step/arm/n_u_0", why, _scene(arm, shapes, [0.6, -0.55], pairs=touch, **stiff)
    passive = [arm[0], {**arm[1], "actuated": False}]
    half = {"K_q": [[50.0]], "q_bar_a": [0.5]}
    why = "the same with a passive elbow"
    yield "step/arm/passive_elbow", why, _scene(passive, shapes, [0.6, -0.55], pairs=touch, **half)
    loose = [{**body, "actuated": False} for body in arm]
    why = "the same without motors"
    yield "step/arm/n_a_0", why, _scene(loose, shapes, [0.6, -0.55], pairs=touch)
    round_ = [{**arm[0], "joint": "continuous"}, {**passive[1], "joint": "continuous"}]
    q, half = [0.8, 0.6, 0.8, -0.6], {"K_q": [[50.0]], "q_bar_a": [0.96, 0.28]}
    why = "joints without end stops: cosine and sine, of length one but for rounding"
    yield "step/arm/continuous", why, _scene(round_, shapes, q, pairs=touch, **half)
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
    shapes = {"floor": _on(None, FLOOR), "tip": _on("tip", BALL), "ball": _on("ball", BALL)}
    pairs = [_pair("ball"), {**_pair("ball"), "name": "push", "alpha": "tip"}]
    q = [*q_a, 0.0, 0.0, 0.05, *UPRIGHT]
    return _scene([pusher, puck], shapes, q, pairs=pairs, **stiff)


def _wedged() -> Json:
    lid = _on(None, {"kind": "halfspace", "normal": [0.0, 0.0, -1.0], "offset": -0.095})
    shapes = {"floor": _on(None, FLOOR), "lid": lid, "ball": _on("ball", BALL)}
    pairs = [_pair("ball"), {**_pair("ball"), "name": "lid", "alpha": "lid"}]
    ball = link("ball", None, "floating", **MASS)
    return _scene([ball], shapes, [0.0, 0.0, 0.048, *UPRIGHT], pairs=pairs)


def _on(body: str | None, shape: Json, x: float = 0.0) -> Json:
    """A shape on a body, or in the world, x [m] from its origin."""
    return {"body": body, "pose": at(x, 0.0, 0.0), "shape": shape}


def _pair(beta: str) -> Json:
    friction = {"mu_v": 0.5, "mu_omega": 0.01, "rows": 6}
    return {"name": "floor", "alpha": "floor", "beta": beta, **friction, "k": 1}


def _scene(bodies: Json, shapes: Json, q: list[float], **more: Any) -> Json:
    plain = {"K_q": [], "q_bar_a": [], "gravity": GRAVITY, "cone": "pyramid", "h": 0.01}
    return {**plain, "mechanism": {"bodies": bodies}, "shapes": shapes, "q": q, **more}
