"""MuJoCo: phenomena by mj_step."""

from typing import Any

import mujoco
import numpy as np
from door import aims, answer, run

JOINT = {
    "free": "<freejoint/>",
    "fixed": "",
    "rail_x": '<joint type="slide" axis="1 0 0"/>',
    "servo": "".join(
        f'<joint name="{{name}}/{x}" type="slide" axis="{axis}" damping="{{damping}}"/>'
        for x, axis in (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))
    ),
}


def words(values: Any) -> str:
    """Numbers for MJCF."""
    return " ".join(repr(float(x)) for x in np.ravel(values))


def geom(shape: Any) -> str:
    """A shape of a body; MuJoCo's sizes are half-lengths."""
    size = [shape["radius"]] if shape["kind"] == "sphere" else np.array(shape["size"]) / 2
    return f'<geom type="{shape["kind"]}" size="{words(size)}" pos="{words(shape["xyz"])}"/>'


def critical_damping(body: Any) -> float:
    """Of a servo's axis [N s/m]."""
    return 2 * float(np.sqrt(body["K"] * body["mass"]))


def joint(body: Any, setting: Any) -> str:
    """Joints of a body. Damping of a servo's joints is implicit in the integrators that are used.

    MuJoCo evaluates springs at the start of a step. With ``implicit_spring`` a spring of stiffness
    K acts from the end of the step: what it gains on the way, -K h v, is more damping.
    """
    if body["joint"] != "servo":
        return JOINT[body["joint"]]
    damping = critical_damping(body)
    if setting.get("implicit_spring"):
        damping += setting["h"] * body["K"]
    return JOINT["servo"].format(name=body["name"], damping=repr(damping))


def servo(body: Any) -> str:
    """Actuators of a servo's axes: a spring to the target's place, a damper to its velocity."""
    return "".join(
        f'<position joint="{body["name"]}/{axis}" kp="{body["K"]!r}"/>'
        f'<motor joint="{body["name"]}/{axis}" gear="{critical_damping(body)!r}"/>'
        for axis in "xyz"
    )


def mjcf(scene: Any, setting: Any) -> str:
    """The scene."""
    condim = 4 if scene["mu_omega"] else 3
    friction = f'condim="{condim}" friction="{scene["mu_v"]!r} {scene["mu_omega"]!r} 0.0001"'
    bodies = ['<geom type="plane" size="1 1 1"/>'] if scene["floor"] else []
    for body in scene["bodies"]:
        geoms = "".join(geom(shape) for shape in body["shapes"])
        floats = "1" if body["joint"] == "servo" else "0"
        bodies.append(
            f'<body name="{body["name"]}" pos="{words(body["xyz"])}" gravcomp="{floats}">'
            f"{joint(body, setting)}"
            f'<inertial pos="0 0 0" mass="{body["mass"]!r}" '
            f'diaginertia="{words(body["inertia"])}"/>{geoms}</body>'
        )
    servos = "".join(servo(body) for body in scene["bodies"] if body["joint"] == "servo")
    option = {"timestep": setting["h"], **setting.get("option", {})}
    return (
        f'<mujoco><option gravity="{words(scene["gravity"])}" '
        f"{' '.join(f'{key}={chr(34)}{value}{chr(34)}' for key, value in option.items())}/>"
        f"<default><geom {friction} {setting.get('geom', '')}/></default>"
        f"<worldbody>{''.join(bodies)}</worldbody>"
        f"<actuator>{servos}</actuator></mujoco>"
    )


mujoco.set_mju_user_warning(lambda _: None)  # else a file MUJOCO_LOG.TXT is written


def phenomena(scene: Any, setting: Any) -> Any:
    """A scene by mj_step."""
    model = mujoco.MjModel.from_xml_string(mjcf(scene, setting))
    data = mujoco.MjData(model)

    def step(loads: Any) -> None:
        for name, load in loads.items():
            data.body(name).xfrc_applied[:] = load.ravel()
        mujoco.mj_step(model, data)

    servos = [body["name"] for body in scene["bodies"] if body["joint"] == "servo"]

    def aim(t: float) -> None:
        targets = aims(scene, t + setting["h"] if setting.get("implicit_spring") else t)
        # Each servo has six controls: place and velocity along x, then y, then z.
        data.ctrl[:] = np.array([np.transpose(targets[name]) for name in servos]).ravel()

    def pose(name: str) -> Any:
        mujoco.mj_kinematics(model, data)
        w, x, y, z = data.body(name).xquat
        return [*data.body(name).xpos, x, y, z, w]

    return run(scene, setting["h"], step, pose, aim if servos else None)


if __name__ == "__main__":
    answer(f"mujoco {mujoco.__version__}", phenomena)
