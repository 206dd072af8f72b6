"""quasistatic_ref itself, by its plain simulator. A pair has its own coefficients."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

import quasistatic_ref
from quasistatic_ref import ContactPair, PlacedShape, Simulator, contact_forces
from quasistatic_ref.lab.made_steps.systems import (
    body_text,
    joint_text,
    link_text,
    robot_text,
    system_of,
    world_plane,
)
from validation.programs.engines.scenes import TIME_STEP, Body, NotMeaningful, Scene, Shape

NAME = f"quasistatic_ref {quasistatic_ref.__version__}"
NO_TORSION = ""
SETTINGS: dict[str, dict[str, Any]] = {
    "pyramid": {"cone": "pyramid", "certify": "off"},
    "ellipsoid": {"cone": "ellipsoid", "certify": "off"},
    "pyramid, steps of 0.1 s": {"cone": "pyramid", "certify": "off", "h": 0.1},
}
NOT_DEFAULT = (
    "Answers are not certified (certify); a table is turned by a spring of 1e6 N m/rad (K_q)."
)
STIFF = 1e6
"""Spring that turns a table [N m/rad]."""
CORNERS = 4
"""Contacts of a pair of faces."""


def urdf(body: Body) -> tuple[str, dict[str, Any]]:
    """URDF of a body, and how it is placed."""
    if body.joint == "free":
        return body_text(body.mass, body.inertia), {"xyz": body.xyz}
    kind, axis = {
        "fixed": ("fixed", "1 0 0"),
        "rail_x": ("prismatic", "1 0 0"),
        "hinge_z": ("revolute", "0 0 1"),
    }[body.joint]
    links = link_text("base", 1.0, (1, 1, 1)), link_text("body", body.mass, body.inertia)
    text = robot_text(*links, joint_text("joint", kind, "base", "body", axis))
    actuated = ["joint"] if body.joint == "hinge_z" else []
    return text, {"base": "fixed", "xyz": body.xyz, "actuated": actuated}


def solid(shape: Shape) -> Any:
    """A shape of this project."""
    if shape.kind == "sphere":
        return quasistatic_ref.Sphere(shape.size[0])
    return quasistatic_ref.Box(size=shape.size)


class Engine:
    """A scene as a simulator and its configuration."""

    def __init__(self, scene: Scene, setting: dict[str, Any]) -> None:
        self.joints = {body.name: body.joint for body in scene.bodies}
        made = {body.name: urdf(body) for body in scene.bodies}
        texts = {name: text for name, (text, _) in made.items()}
        self.system = system_of(texts, **{name: place for name, (_, place) in made.items()})
        first, *others = map(self.placed, scene.bodies)
        against = [[world_plane()]] if scene.floor else others
        pairs = [
            ContactPair(f"{a.name}, {b.name}", a, b, scene.mu_v, scene.mu_omega, 6, CORNERS)
            for shapes in against
            for a in shapes
            for b in first
        ]
        gravity = (0.0, 0.0, -scene.gravity)
        numbers = {"h": TIME_STEP, "gravity": gravity, "K_q": STIFF, **setting}
        self.simulator = Simulator(self.system, pairs, **numbers)
        self.turning = scene.turning
        self.steps = 0
        self.q = self.system.q_start

    def link(self, name: str) -> str:
        """The link of a body that moves."""
        return name if self.joints[name] == "free" else f"{name}/body"

    def placed(self, body: Body) -> list[PlacedShape]:
        """Shapes of a body."""
        link = self.system.link(self.link(body.name))
        return [
            PlacedShape(f"{body.name} {k}", link, np.eye(3), np.array(shape.xyz), solid(shape))
            for k, shape in enumerate(body.shapes)
        ]

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        load = np.zeros(self.system.n_v)
        for name, (force, torque) in wrenches.items():
            if self.joints[name] == "free":
                load += self.system.load(self.q, name, force, torque)
            elif self.joints[name] == "rail_x":
                load[self.system.joint(f"{name}/joint").v] += force[0]
        self.steps += 1
        angles = [self.turning.angle(self.steps * self.simulator.h)] if self.turning else []
        self.result = self.simulator.step(self.q, np.array(angles), load)
        self.q = self.result.q

    def pose(self, name: str) -> list[float]:
        links = self.system.kinematics(self.q)
        k = self.system.link(self.link(name))
        return [*links.t[k], *Rotation.from_matrix(links.R[k]).as_quat()]

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        if self.simulator.cone != "pyramid":
            raise NotMeaningful("forces of single contacts are asked of the pyramid alone")
        forces = contact_forces(self.result.step).wrench[:, 2]
        return list(zip(self.result.points.beta, forces.tolist(), strict=True))
