"""Steps that tell forces and their points of attack apart, and joints that follow others.

The centre of mass is not the origin of its body wherever a wrench or gravity acts.
"""

from collections.abc import Iterator

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import UPRIGHT, at, follower, link
from quasistatic_ref.lab.vectors.families.step_scenes import (
    BALL,
    FLOOR,
    MASS,
    TILTED,
    ball_scene,
    on,
    pair,
    scene,
)

OFF: Json = {**MASS, "com": [0.01, 0.02, -0.015]}
PUSH: Json = {"force": [0.6, -0.3, -1.0], "torque": [0.01, 0.0, 0.02]}
SIDEWAYS = [4.0, -3.0, -8.0]
WALL: Json = {"kind": "halfspace", "normal": [-1.0, 0.0, 0.0], "offset": -0.3}


def force_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    pushed = [{"body": "ball", **PUSH}]
    why = "a ball whose centre of mass is not its centre, pushed at its centre of mass"
    yield "step/forces/off_centre", why, ball_scene([0.0, 0.0, 0.05], wrenches=pushed, **OFF)
    why = "the same, turned: the centre of mass and the inertia turn with the body"
    turned = ball_scene([0.0, 0.0, 0.05], quaternion=TILTED, wrenches=pushed, **OFF)
    yield "step/forces/turned", why, turned
    why = "two wrenches on one body: they add"
    yield "step/forces/two", why, {**turned, "wrenches": 2 * pushed}
    why = "the same body falls in a gravity that is along no axis"
    falling = ball_scene([0.1, 0.2, 0.5], quaternion=TILTED, gravity=SIDEWAYS, **OFF)
    yield "step/gravity/falling", why, falling
    why = "and rests on the floor in that gravity, with friction"
    resting = ball_scene([0.1, 0.2, 0.05], quaternion=TILTED, gravity=SIDEWAYS, **OFF)
    yield "step/gravity/resting", why, resting
    sloped = {"kind": "halfspace", "normal": [0.3, 0.4, 1.2], "offset": 0.165}
    why = "a half-space whose normal has length 1.3: its offset is divided by 1.3 too"
    above = ball_scene([0.06, 0.08, 0.15], quaternion=TILTED)  # 0.23 - 0.165 = 1.3 * 0.05
    above["shapes"]["floor"] = on(None, sloped)
    yield "step/ball/normal", why, above
    sides = [{"body": name, **PUSH} for name in ("upper", "tip")]
    for n_a, name, why in (
        (2, "actuated", "wrenches on both links of an actuated arm"),
        (1, "elbow", "the same with a passive elbow: gravity acts on it alone"),
        (0, "passive", "the same without motors"),
    ):
        arm, shapes, touch = _arm(n_a)
        K_q = [row[:n_a] for row in [[50.0, 5.0], [5.0, 20.0]][:n_a]]
        stiff = {"K_q": K_q, "q_bar_a": [0.5, -0.5][:n_a]}
        forces = {"wrenches": sides, "gravity": SIDEWAYS}
        table = scene(arm, shapes, [0.6, -0.55], pairs=touch, **stiff, **forces)
        yield f"step/forces/{name}", why, table
    for joint, actuated in (("prismatic", True), ("revolute", True), ("revolute", False)):
        name = f"step/mimic/{joint}_{'actuated' if actuated else 'passive'}"
        why = f"a {joint} joint at -1/2 of another, and 0.35 away from that, touches a ball"
        yield name, why, _follower(joint, actuated)


def _arm(n_a: int) -> tuple[Json, Json, Json]:
    swing = {"axis": [0.0, 1.0, 0.0], **OFF}
    arm = [
        link("upper", None, "revolute", actuated=n_a > 0, **swing),
        link("tip", "upper", "revolute", actuated=n_a > 1, placement=at(0.2, 0, 0), **swing),
    ]
    shapes = {"wall": on(None, WALL), "tip": on("tip", {"kind": "sphere", "radius": 0.02}, 0.1)}
    return arm, shapes, [{**pair("tip"), "alpha": "wall"}]


def _follower(joint: str, actuated: bool) -> Json:
    """A drive, a finger that follows it, and a ball on the floor that the finger touches."""
    drive, finger = (body | OFF for body in follower(joint, "stand", actuated=actuated))
    ball = link("ball", None, "floating", **OFF)
    # At 0.3 of the drive the finger is at 0.35 - 0.15 = 0.2: 0.2 m along x, or 0.2 rad about y.
    # 0.2 cos 0.2 = 0.19601 and 0.2 sin 0.2 = 0.03973: the tip is as high as the ball.
    arm, x, z = (0.0, 0.2, 0.05) if joint == "prismatic" else (0.2, 0.196, 0.0897)
    finger["placement"] = at(0.0, 0.0, z)
    shapes = {
        "floor": on(None, FLOOR),
        "tip": on("finger", {"kind": "sphere", "radius": 0.02}, arm),
        "ball": on("ball", BALL),
    }
    touch = [pair("ball"), {**pair("ball"), "name": "push", "alpha": "tip"}]
    own = [x + 0.0695, 0.001, 0.05, *UPRIGHT]
    stiff: Json = {"K_q": [[80.0]], "q_bar_a": [0.28]} if actuated else {}
    bodies = [link("stand", None, "fixed"), drive, finger, ball]
    return scene(bodies, shapes, [0.3, *own], pairs=touch, **stiff)
