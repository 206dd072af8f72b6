"""Our rows of a step against MuJoCo's efc_J, at MuJoCo's own contact points and frames."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from quasistatic_ref.contact.jacobian import contact_jacobian
from quasistatic_ref.model.system import System
from quasistatic_ref.step.data import Array, Contacts
from quasistatic_ref.step.friction import friction_rows
from quasistatic_ref.validate.claim import Claim, Evidence, comparison, within
from quasistatic_ref.validate.engines.mujoco_scenes import Heap, heap

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
            if joint.kind == "floating":
                block[:3, :3] = kinematics.R[system.link(name)]
            T[row : row + size, joint.v] = block
            row += size
    return T


def rows_of(scene: Heap) -> dict[str, Array]:
    """Both engines' rows of every contact, and what the contact point accounts for."""
    mujoco: Any = import_module("mujoco")
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    system = scene.system
    T = tangent_map(system, scene.bodies)
    theirs, points, frames, phi, mu, links, spins = [], [], [], [], [], [], []
    J = data.efc_J.reshape(data.nefc, -1)
    for contact in data.contact:
        if contact.efc_address < 0 or contact.dim != 4:
            continue
        address, omega = contact.efc_address, np.zeros((3, model.nv))
        theirs.append(J[address : address + 6] @ T)
        frames.append(contact.frame.reshape(3, 3).copy())
        points.append(contact.pos.copy())
        phi.append(contact.dist)
        mu.append(contact.friction[[0, 1, 2]])
        geoms = [model.geom(g).name for g in (contact.geom1, contact.geom2)]
        links.append([0 if n == "floor" else system.link(f"{n}/{n}") for n in geoms])
        for geom in (contact.geom1, contact.geom2):
            jacr = np.zeros((3, model.nv))
            mujoco.mj_jacBody(model, data, None, jacr, model.geom_bodyid[geom])
            omega += jacr
        spins.append(omega @ T)
    n, d1, d2 = np.array(frames).transpose(1, 0, 2)
    gap, p, m = np.array(phi), np.array(points), np.array(mu)
    half = gap[:, None] / 2 * n
    link = np.array(links)
    kinematics = system.kinematics(system.q_start)
    ours_J = contact_jacobian(kinematics, link[:, 0], link[:, 1], p - half, p + half, n)
    names = tuple(str(i) for i in range(len(gap)))
    found = Contacts(names, gap, n, d1, d2, ours_J, m[:, 0], m[:, 2], np.full(len(gap), 6))
    # (R20), one contact point instead of two: +- mu_k (phi/2) (n x t_k).(omega_1 + omega_2).
    lever = [np.einsum("cr,crv->cv", np.cross(n, t), np.array(spins)) for t in (d1, d2)]
    shift = np.stack([lever[0], -lever[0], lever[1], -lever[1], 0 * lever[0], 0 * lever[0]], axis=1)
    shift *= (m[:, :1] * gap[:, None] / 2)[:, :, None]
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    u = slice(system.n_a, None)
    return {
        "ours": friction_rows(found),
        "theirs": np.array(theirs)[:, ORDER],
        "shift": shift[:, ORDER],
        "ours M": system.M_u(system.q_start),
        "theirs M": (T.T @ M @ T)[u, u],
    }


def evidence() -> Evidence:
    """Twelve heaps."""
    scenes = [rows_of(heap(seed)) for seed in range(SCENES)]

    def all_of(key: str, part: slice = slice(None)) -> Array:
        return np.concatenate([scene[key][:, part].ravel() for scene in scenes])

    tangential, spin = slice(0, 4), slice(4, 6)
    ours, shift = all_of("ours", tangential), all_of("shift", tangential)
    moved = all_of("theirs", tangential) + shift
    spins = all_of("ours", spin), all_of("theirs", spin)
    M, theirs_M = (np.concatenate([s[k].ravel() for s in scenes]) for k in ("ours M", "theirs M"))
    largest = float(np.abs(theirs_M).max())
    return Evidence(
        (
            comparison("torsional rows [-, m]", *spins, tolerance=ROWS_TOLERANCE),
            comparison("tangential rows, their point moved [-, m]", ours, moved, ROWS_TOLERANCE),
            within("largest entry of that move [m]", np.abs(shift).max(), 1e-4, np.inf),
            comparison("mass matrices [kg, kg m, kg m^2]", M, theirs_M, ROWS_TOLERANCE, largest),
            within("contacts", sum(len(s["ours"]) for s in scenes), 2 * SCENES, np.inf),
        ),
    )


CLAIM = Claim(
    name="mujoco_rows",
    sentence="Our rows are MuJoCo's efc_J (condim 4, pyramidal), after a permutation, the tangent "
    "map, "
    "and +- mu_k (phi/2) (n x t_k).(omega_1 + omega_2) for its one contact point midway.",
    where="docs/derivations.md (R20); MuJoCo's own contact points and frames",
    sweep="12 heaps of 3 to 6 bodies, one of them on a hinge: spheres, boxes, capsules, cylinders",
    reason="ROWS_TOLERANCE; the shift itself is larger by ten orders of magnitude.",
    measure=evidence,
    engine="mujoco",
)
