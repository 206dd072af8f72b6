"""Tables of a case, written by hand: bodies, poses, shapes in the world, whole scenes."""

from typing import Any

from quasistatic_ref.lab.vectors.trees import Json

UPRIGHT = [0.0, 0.0, 0.0, 1.0]
ORIGIN: Json = {"xyz": [0.0, 0.0, 0.0], "quaternion": UPRIGHT}
GRAVITY = [0.0, 0.0, -9.81]


def at(x: float, y: float, z: float) -> Json:
    """A pose at x, y, z [m]."""
    return {"xyz": [x, y, z], "quaternion": UPRIGHT}


def link(name: str, parent: str | None, joint: str, **more: Any) -> Json:
    """One body of a mechanism, massless and at the parent's origin by default."""
    table: Json = {"name": name, "parent": parent, "placement": ORIGIN, "joint": joint}
    table |= {"axis": [0.0, 0.0, 1.0], "actuated": False}
    return table | more


def follower(joint: str, parent: str | None = None, **more: Any) -> list[Json]:
    """A revolute or prismatic joint, and one that follows it backwards at half its pace."""
    follow = {"of": "drive", "multiplier": -0.5, "offset": 0.35}
    moves = {"axis": [1.0, 0.0, 0.0] if joint == "prismatic" else [0.0, 1.0, 0.0], **more}
    drive = link("drive", parent, joint, **moves)
    return [drive, link("finger", parent, joint, mimic=follow, **moves)]


def free_body(name: str = "object", **more: Any) -> Json:
    """One floating body."""
    inertia = [[0.002, 0.0, 0.0], [0.0, 0.003, 0.0], [0.0, 0.0, 0.004]]
    return link(name, None, "floating", mass=1.0, com=[0.0] * 3, inertia=inertia, **more)


def on(body: str | None, shape: Json, x: float = 0.0) -> Json:
    """A shape on a body, or in the world, x [m] from its origin."""
    return {"body": body, "pose": at(x, 0.0, 0.0), "shape": shape}


def scene(bodies: Json, shapes: Json, q: list[float], **more: Any) -> Json:
    """The input of a case; without more, nothing is actuated, and things fall down."""
    plain = {"K_q": [], "q_bar_a": [], "gravity": GRAVITY, "cone": "pyramid", "h": 0.01}
    return {**plain, "mechanism": {"bodies": bodies}, "shapes": shapes, "q": q, **more}
