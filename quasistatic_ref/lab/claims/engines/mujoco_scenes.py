"""Random heaps of bodies, as MJCF for MuJoCo and as URDF for us."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.scenes.systems import joint_text, link_text, robot_text, system_of, words
from quasistatic_ref.model.system import System

FREE = ("ball", "brick", "pill", "drum", "pebble")
"""Free bodies; the arm turns about a hinge. MuJoCo's order of coordinates is this, then the arm."""

GEOMS = {
    "ball": ("sphere", (0.10,)),
    "brick": ("box", (0.08, 0.06, 0.10)),
    "pill": ("capsule", (0.05, 0.08)),
    "drum": ("cylinder", (0.07, 0.06)),
    "pebble": ("sphere", (0.05,)),
    "arm": ("capsule", (0.04, 0.12)),
}


@dataclass(frozen=True, eq=False)
class Heap:
    """One scene for both engines.

    Parameters
    ----------
    mjcf : str
    system : System
        Its hinge is actuated, so that its coordinate comes first in our order and last in MuJoCo's.
    bodies : tuple of str
        In MuJoCo's order.
    """

    mjcf: str
    system: System
    bodies: tuple[str, ...]


def heap(seed: int) -> Heap:
    """Some bodies, so near to each other that they touch, above a floor."""
    rng = np.random.default_rng(seed)
    free = tuple(rng.permutation(FREE)[: 2 + seed % 4])
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    texts: dict[str, str] = {}
    settings: dict[str, dict[str, Any]] = {}
    bodies: list[str] = []
    for name in (*free, "arm"):
        spread = 0.12 * np.sqrt(len(free))
        xyz = rng.uniform(-0.5, 0.5, 3) * spread + [0, 0, 0.1]
        rpy = rng.uniform(-1.5, 1.5, 3)
        mass = float(rng.uniform(0.2, 2.0))
        inertia = rng.uniform(2e-3, 3e-3, 3).tolist()
        com = rng.uniform(-0.02, 0.02, 3).tolist()
        friction = (float(rng.uniform(0.2, 1.0)), float(rng.uniform(0.005, 0.05)))
        link = link_text(name, mass, inertia, com=com)
        placed = {"xyz": tuple(xyz), "rpy": tuple(rpy)}
        if name == "arm":
            base = link_text("base", 1.0, (1, 1, 1))
            turn = joint_text("hinge", "revolute", "base", "arm", words(axis))
            texts[name] = robot_text(base, link, turn)
            settings[name] = {"base": "fixed", "actuated": "all", **placed}
            joint = f'<joint type="hinge" axis="{words(axis)}"/>'
        else:
            texts[name] = robot_text(link)
            settings[name] = placed
            joint = "<freejoint/>"
        kind, size = GEOMS[name]
        bodies.append(
            f'<body name="{name}" pos="{words(xyz)}" euler="{words(rpy)}">{joint}'
            f'<inertial pos="{words(com)}" mass="{mass!r}" diaginertia="{words(inertia)}"/>'
            f'<geom name="{name}" type="{kind}" size="{words(size)}" '
            f'friction="{friction[0]!r} {friction[1]!r} 0.001"/></body>'
        )
    mjcf = (
        '<mujoco><compiler angle="radian" eulerseq="XYZ"/>'
        '<option cone="pyramidal" jacobian="dense"/><default><geom condim="4"/></default>'
        '<worldbody><geom name="floor" type="plane" size="2 2 1" friction="0.3 0.01 0.001"/>'
        f"{''.join(bodies)}</worldbody></mujoco>"
    )
    return Heap(mjcf, system_of(texts, **settings), (*free, "arm"))
