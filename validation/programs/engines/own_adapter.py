"""quasistatic_ref itself, by the same door: phenomena by its simulator, each step certified."""

from typing import Any

import numpy as np
from door import aims, answer, run
from scipy.spatial.transform import Rotation

from quasistatic_ref import __version__
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.systems import (
    body_text,
    joint_text,
    link_text,
    robot_text,
    system_of,
    world_plane,
)
from quasistatic_ref.shapes.placed_shape import Box, PlacedShape, Sphere
from quasistatic_ref.simulate.simulator import Simulator


def robot(body: Any) -> tuple[str, dict[str, Any]]:
    """URDF of a body, and how it is placed."""
    if body["joint"] == "free":
        return body_text(body["mass"], body["inertia"]), {"xyz": tuple(body["xyz"])}
    link = link_text("body", body["mass"], body["inertia"])
    if body["joint"] == "servo":
        return servo_text(link), {"base": "fixed", "actuated": "all", "xyz": tuple(body["xyz"])}
    kind = {"fixed": "fixed", "rail_x": "prismatic"}[body["joint"]]
    joint = joint_text("joint", kind, "base", "body")
    text = robot_text(link_text("base", 1.0, (1, 1, 1)), link, joint)
    return text, {"base": "fixed", "xyz": tuple(body["xyz"])}


def servo_text(link: str) -> str:
    """URDF of a link that moves along x, y and z."""
    light = (1e-9, 1e-9, 1e-9)
    return robot_text(
        link_text("base", 1.0, (1, 1, 1)),
        link_text("at_x", 1e-6, light),
        link_text("at_y", 1e-6, light),
        link,
        joint_text("x", "prismatic", "base", "at_x", "1 0 0"),
        joint_text("y", "prismatic", "at_x", "at_y", "0 1 0"),
        joint_text("z", "prismatic", "at_y", "body", "0 0 1"),
    )


def solid(shape: Any) -> Any:
    """A shape."""
    return Sphere(shape["radius"]) if shape["kind"] == "sphere" else Box(size=shape["size"])


def phenomena(scene: Any, setting: Any) -> Any:
    """A scene, step by step."""
    bodies = {body["name"]: body for body in scene["bodies"]}
    made = {name: robot(body) for name, body in bodies.items()}

    def link(name: str) -> str:
        return name if bodies[name]["joint"] == "free" else f"{name}/body"

    system = system_of(
        {name: text for name, (text, _) in made.items()},
        **{name: place for name, (_, place) in made.items()},
    )
    placed = {"floor": [world_plane()]}
    for name, body in bodies.items():
        placed[name] = [
            PlacedShape(f"{name} {k}", system.link(link(name)), np.eye(3), np.array(shape["xyz"]),
                        solid(shape))
            for k, shape in enumerate(body["shapes"])
        ]  # fmt: skip
    pairs = [
        ContactPair(f"{a.name}, {b.name}", a, b, scene["mu_v"], scene["mu_omega"], 6, 1)
        for first, second, *shapes in scene["contacts"]
        for a in placed[first]
        for b in (placed[second][k] for k in (shapes[0] if shapes else range(len(placed[second]))))
    ]
    servos = [name for name, body in bodies.items() if body["joint"] == "servo"]
    K_q = np.diag([bodies[name]["K"] for name in servos for _ in "xyz"])
    simulator = Simulator(
        system, pairs, h=setting["h"], K_q=K_q,
        gravity=np.array(scene["gravity"]), **setting.get("simulator", {}),
    )  # fmt: skip
    state = {"q": system.q_start, "target": np.zeros(system.n_a)}

    def aim(t: float) -> None:
        targets = aims(scene, t + setting["h"])
        if servos:
            state["target"] = np.concatenate([targets[name][0] for name in servos])

    def step(loads: Any) -> None:
        force = np.zeros(system.n_v)
        for name, load in loads.items() if scene["loads"] else ():
            if bodies[name]["joint"] == "free":
                force += system.load(state["q"], name, *load)
            elif bodies[name]["joint"] == "rail_x":
                force[system.joint(f"{name}/joint").v] += load[0, 0]
        state["q"] = simulator.step(state["q"], state["target"], force).q

    def pose(name: str) -> Any:
        at = system.kinematics(state["q"])
        k = system.link(link(name))
        return [*at.t[k], *Rotation.from_matrix(at.R[k]).as_quat()]

    return run(scene, setting["h"], step, pose, aim)


if __name__ == "__main__":
    answer(f"quasistatic_ref {__version__}", phenomena)
