"""What the scenes of the layer `step` are made of: shapes, masses, pairs."""

from typing import Any

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.mechanisms import UPRIGHT, at, link

GRAVITY = [0.0, 0.0, -9.81]
BALL: Json = {"kind": "sphere", "radius": 0.05}
FLOOR: Json = {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
MASS: Json = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.001, 0.0, 0.0], [0.0, 0.0012, 0.0], [0.0, 0.0, 0.0014]],
}


def ball_scene(wrench: Json) -> Json:
    """A ball on a floor, and a wrench on it."""
    ball = link("ball", None, "floating", **MASS)
    shapes = {"floor": on(None, FLOOR), "ball": on("ball", BALL)}
    friction = {"mu_v": 0.5, "mu_omega": 0.01, "rows": 6}
    pair = {"name": "floor", "alpha": "floor", "beta": "ball", **friction, "k": 1}
    q = [0.0, 0.0, 0.05, *UPRIGHT]
    return scene([ball], shapes, q, pairs=[pair], wrenches=[{"body": "ball", **wrench}])


def on(body: str | None, shape: Json, x: float = 0.0) -> Json:
    """A shape on a body, or in the world, x [m] from its origin."""
    return {"body": body, "pose": at(x, 0.0, 0.0), "shape": shape}


def scene(bodies: Json, shapes: Json, q: list[float], **more: Any) -> Json:
    """The input of a case; without more, nothing is actuated, and things fall down."""
    plain = {"K_q": [], "q_bar_a": [], "gravity": GRAVITY, "cone": "pyramid", "h": 0.01}
    return {**plain, "mechanism": {"bodies": bodies}, "shapes": shapes, "q": q, **more}
