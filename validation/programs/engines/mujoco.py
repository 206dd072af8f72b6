"""MuJoCo, by mj_step. A pair's friction is the larger of its bodies' coefficients."""

from typing import Any

import mujoco
import numpy as np

from validation.programs.engines.scenes import TIME_STEP, Body, Scene, Shape

NAME = f"mujoco {mujoco.__version__}"
NO_TORSION = ""
NOSLIP = {"noslip_iterations": 100, "noslip_tolerance": 0}
SETTINGS: dict[str, dict[str, Any]] = {
    "pyramidal": {"cone": "pyramidal"},
    "pyramidal, noslip": {"cone": "pyramidal", **NOSLIP},
    "elliptic": {"cone": "elliptic"},
    "elliptic, impratio 100": {"cone": "elliptic", "impratio": 100},
    "elliptic, noslip": {"cone": "elliptic", **NOSLIP},
}
NOT_DEFAULT = (
    "condim = 4, multiccd. Noslip: noslip_iterations = 100, noslip_tolerance = 0. solref and "
    "solimp have their defaults (0.02 1 and 0.9 0.95 0.001): the time constant of contacts is "
    "20 ms."
)
COMMON = {"timestep": TIME_STEP, "integrator": "Euler", "solver": "Newton", "iterations": 100}
JOINTS = {
    "free": "<freejoint/>",
    "fixed": "",
    "rail_x": '<joint type="slide" axis="1 0 0" damping="0"/>',
    "hinge_z": '<joint type="hinge" axis="0 0 1" damping="0"/>',
}

mujoco.set_mju_user_warning(lambda _: None)  # else MuJoCo writes a file MUJOCO_LOG.TXT


def words(values: Any) -> str:
    """Numbers for MJCF."""
    return " ".join(repr(float(x)) for x in np.ravel(values))


def geom(shape: Shape) -> str:
    """A shape of a body; MuJoCo's sizes of boxes are half-lengths."""
    size = shape.size if shape.kind == "sphere" else np.array(shape.size) / 2
    return f'<geom type="{shape.kind}" size="{words(size)}" pos="{words(shape.xyz)}"/>'


def element(body: Body) -> str:
    """A body."""
    return (
        f'<body name="{body.name}" pos="{words(body.xyz)}">{JOINTS[body.joint]}'
        f'<inertial pos="0 0 0" mass="{body.mass!r}" diaginertia="{words(body.inertia)}"/>'
        f"{''.join(map(geom, body.shapes))}</body>"
    )


def mjcf(scene: Scene, setting: dict[str, Any]) -> str:
    """The scene; condim 4 has torsional friction, and no rolling friction."""
    options = " ".join(f'{key}="{value}"' for key, value in {**COMMON, **setting}.items())
    floor = '<geom type="plane" size="1 1 1"/>' if scene.floor else ""
    friction = f"{words([scene.mu_v, scene.mu_omega])} 0"
    return (
        f'<mujoco><option gravity="0 0 {-scene.gravity!r}" {options}>'
        '<flag nativeccd="enable" multiccd="enable" sleep="disable"/></option>'
        f'<default><geom condim="4" friction="{friction}"/></default>'
        f"<worldbody>{floor}{''.join(map(element, scene.bodies))}</worldbody></mujoco>"
    )


class Engine:
    """A scene as a model and its data."""

    def __init__(self, scene: Scene, setting: dict[str, Any]) -> None:
        self.model = mujoco.MjModel.from_xml_string(mjcf(scene, setting))
        self.data = mujoco.MjData(self.model)

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        for name, wrench in wrenches.items():
            self.data.body(name).xfrc_applied[:] = wrench.ravel()
        mujoco.mj_step(self.model, self.data)

    def pose(self, name: str) -> list[float]:
        mujoco.mj_kinematics(self.model, self.data)
        w, x, y, z = self.data.body(name).xquat
        return [*self.data.body(name).xpos, x, y, z, w]

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        forces = []
        for k, contact in enumerate(self.data.contact):
            wrench = np.zeros(6)
            mujoco.mj_contactForce(self.model, self.data, k, wrench)
            forces.append((contact.pos.copy(), float(wrench[0])))
        return forces
