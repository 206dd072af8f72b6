"""Random heaps of bodies, as MJCF for MuJoCo and as URDF for us."""

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, within
from quasistatic_ref.lab.made_steps.contacts import contacts_of
from quasistatic_ref.lab.made_steps.link_jacobian import contact_jacobian
from quasistatic_ref.lab.made_steps.systems import (
    joint_text,
    link_text,
    robot_text,
    system_of,
    words,
)
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.pyramid import pyramid
from quasistatic_ref.step.standard_form import friction_rows

# Random heaps of bodies, as MJCF for MuJoCo and as URDF for us.

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
    """A heap of bodies above a floor, as a scene of both engines.

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
    """Bodies above a floor, so near to each other that they touch."""
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


# Our rows of a step against MuJoCo's efc_J, at MuJoCo's own contact points and frames.

SCENES = 12
ORDER = [0, 2, 1, 3, 4, 5]
"""Our rows +d1 +d2 -d1 -d2 +s -s, of MuJoCo's +t1 -t1 +t2 -t2 +s -s."""

ROWS_TOLERANCE = 1e-13
"""Entries are at most some 1 m: a few products of rotations, rounded on either side."""


def tangent_map(system: System, bodies: tuple[str, ...]) -> Array:
    """T with MuJoCo's velocity = T delta_q, shape (n_v, n_v).

    MuJoCo's free joint has a world linear and a body angular velocity, ours has both in the body's
    axes; its order is that of the bodies, ours begins with what is actuated.
    """
    kinematics = system.kinematics(system.q_start)
    T = np.zeros((system.n_v, system.n_v))
    row = 0
    for name in bodies:
        for joint in system.joints:
            if not joint.name.startswith(f"{name}/"):
                continue
            size = joint.v.stop - joint.v.start
            block = np.eye(size)
            if joint.free:
                block[:3, :3] = kinematics.R[system.link(name)]
            T[row : row + size, joint.v] = block
            row += size
    return T


def mujoco_contacts(scene: Heap, cone: str) -> dict[str, Array]:
    """MuJoCo's contacts as arrays with one row a contact; J has the columns of delta_q.

    Returns
    -------
    dict
        rows (of efc_J: 6 pyramidal, 4 elliptic), point, frame, phi, friction, link (of both),
        omega (omega_1 + omega_2, shape (3, n_v)); and M, the mass matrix.
    """
    mujoco: Any = import_module("mujoco")
    model = mujoco.MjModel.from_xml_string(scene.mjcf.replace("pyramidal", cone))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    T = tangent_map(scene.system, scene.bodies)
    size = 6 if cone == "pyramidal" else 4
    J = data.efc_J.reshape(data.nefc, -1) @ T
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    columns: dict[str, list[Any]] = {}
    for contact in data.contact:
        if contact.efc_address < 0 or contact.dim != 4:
            continue
        links = []
        omega = np.zeros((3, model.nv))
        for geom in (contact.geom1, contact.geom2):
            name = model.geom(geom).name
            jacr = np.zeros((3, model.nv))
            links.append(0 if name == "floor" else scene.system.link(f"{name}/{name}"))
            mujoco.mj_jacBody(model, data, None, jacr, model.geom_bodyid[geom])
            omega += jacr
        one = {
            "rows": J[contact.efc_address : contact.efc_address + size],
            "point": contact.pos.copy(),
            "frame": contact.frame.reshape(3, 3).copy(),
            "phi": contact.dist,
            "friction": contact.friction.copy(),
            "link": links,
            "omega": omega @ T,
        }
        for key, value in one.items():
            columns.setdefault(key, []).append(value)
    return {key: np.array(values) for key, values in columns.items()} | {"M": T.T @ M @ T}


def rows_of(scene: Heap) -> dict[str, Array]:
    """Both engines' rows (n_c, 6, n_v), and what the place of the contact point accounts for."""
    theirs = mujoco_contacts(scene, "pyramidal")
    system = scene.system
    n, d1, d2 = theirs["frame"].transpose(1, 0, 2)
    phi, point, mu = (theirs[key] for key in ("phi", "point", "friction"))
    link = theirs["link"].astype(np.int64)
    half = phi[:, None] / 2 * n
    kinematics = system.kinematics(system.q_start)
    alpha = point - half
    beta = point + half
    J = contact_jacobian(kinematics, link[:, 0], link[:, 1], alpha, beta, n)
    ours = contacts_of(phi, np.stack([d1, d2, n], axis=1), J, mu[:, 0], mu[:, 2], rows=6)
    # (R20), one contact point instead of two: (phi/2) (n x t_k).(omega_1 + omega_2), times +- mu_k.
    t1, t2 = (
        phi[:, None] / 2 * np.einsum("cr,crv->cv", np.cross(n, t), theirs["omega"])
        for t in (d1, d2)
    )
    none = np.zeros_like(t1)
    axes = [np.einsum("cr,crv->cv", axis, J[:, :3]) for axis in (n, d1, d2)]
    u = slice(system.n_a, None)
    return {
        "ours": friction_rows(ours),
        "theirs": theirs["rows"][:, ORDER],
        "shift": np.stack(pyramid(none, mu[:, :1] * t1, mu[:, :1] * t2, none), axis=1),
        "ours elliptic": np.stack([*axes, J[:, 3]], axis=1),
        "theirs elliptic": mujoco_contacts(scene, "elliptic")["rows"],
        "shift elliptic": np.stack([none, t1, t2, none], axis=1),
        "ours M": system.M_u(system.q_start),
        "theirs M": theirs["M"][u, u],
    }


def evidence() -> list[Comparison]:
    """Our rows and M_u against those of MuJoCo, in twelve random heaps of bodies."""
    scenes = [rows_of(heap(seed)) for seed in range(SCENES)]

    def all_of(key: str, part: slice = slice(None)) -> Array:
        return np.concatenate([scene[key][:, part].ravel() for scene in scenes])

    tangential = slice(0, 4)
    spin = slice(4, 6)
    ours = all_of("ours", tangential)
    shift = all_of("shift", tangential)
    moved = all_of("theirs", tangential) + shift
    spins = all_of("ours", spin), all_of("theirs", spin)
    axes = all_of("ours elliptic")
    their_axes = all_of("theirs elliptic") + all_of("shift elliptic")
    M, theirs_M = (np.concatenate([s[k].ravel() for s in scenes]) for k in ("ours M", "theirs M"))
    largest = float(np.abs(theirs_M).max())
    return [
        comparison("torsional rows [-, m]", *spins, tolerance=ROWS_TOLERANCE),
        comparison("tangential rows, their point moved [-, m]", ours, moved, ROWS_TOLERANCE),
        comparison("J against elliptic rows, the same [-, m]", axes, their_axes, ROWS_TOLERANCE),
        within("largest entry of that move [m]", np.abs(shift).max(), 1e-4, np.inf),
        comparison("mass matrices [kg, kg m, kg m^2]", M, theirs_M, ROWS_TOLERANCE, largest),
        within("contacts", sum(len(s["ours"]) for s in scenes), 2 * SCENES, np.inf),
    ]


CLAIM = Claim(
    name="mujoco_rows",
    sentence="Our rows, and J itself, are MuJoCo's efc_J (condim 4, pyramidal and elliptic), "
    "after a permutation, the tangent map, and +- mu_k (phi/2) (n x t_k).(omega_1 + omega_2) for "
    "its one contact point midway.",
    where="docs/derivations.md (R20); MuJoCo's own contact points and frames",
    sweep="12 heaps of 3 to 6 bodies, one of them on a hinge: spheres, boxes, capsules, cylinders",
    reason="ROWS_TOLERANCE; the shift itself is larger by ten orders of magnitude.",
    measure=evidence,
    engine="mujoco",
    setting="condim 4, cone pyramidal and elliptic, jacobian dense",
)
