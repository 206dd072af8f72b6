"""What the scenes of the layer `step` are made of: shapes, masses, pairs."""

from typing import Any

from quasistatic_ref.lab.vectors.expected import Json
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


def ball_scene(xyz: list[float], *, quaternion: Any = UPRIGHT, **more: Any) -> Json:
    """A ball over a floor; `more` are fields of its body and of the case."""
    body = {key: more.pop(key) for key in ("mass", "com", "inertia") if key in more}
    ball = link("ball", None, "floating", **{**MASS, **body})
    shapes = {"floor": on(None, FLOOR), "ball": on("ball", BALL)}
    return scene([ball], shapes, [*xyz, *quaternion], **{"pairs": [pair("ball")], **more})


def on(body: str | None, shape: Json, x: float = 0.0) -> Json:
    """A shape on a body, or in the world, x [m] from its origin."""
    return {"body": body, "pose": at(x, 0.0, 0.0), "shape": shape}


def pair(beta: str) -> Json:
    """The pair of the floor and of another shape."""
    friction = {"mu_v": 0.5, "mu_omega": 0.01, "rows": 6}
    return {"name": "floor", "alpha": "floor", "beta": beta, **friction, "k": 1}


def scene(bodies: Json, shapes: Json, q: list[float], **more: Any) -> Json:
    """The input of a case; without more, nothing is actuated, and things fall down."""
    plain = {"K_q": [], "q_bar_a": [], "gravity": GRAVITY, "cone": "pyramid", "h": 0.01}
    return {**plain, "mechanism": {"bodies": bodies}, "shapes": shapes, "q": q, **more}
