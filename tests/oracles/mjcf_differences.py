"""MJCF models against MuJoCo.

At random configurations, each body's mass, pose and Jacobian, the mass matrix and signed distances
of shapes are compared with MuJoCo's. Of random models of meshes, it is also compared how far each
mesh reaches, with MuJoCo's compiled vertices and with those that the files hold.
"""

import tempfile
from collections import Counter
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref import Body, ContactError, ContactPair, ModelError, System
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.optional.mjcf.mjcf import mjcf_urdf
from quasistatic_ref.optional.mjcf.names import Names
from quasistatic_ref.step.data import Array
from tests.oracles.random_mjcf import random_model

mujoco = import_module("mujoco")
SAME, CURVED = 1e-12, 1e-6
"""Tolerances: relative to the largest entry; of distances to cylinders and boxes, which MuJoCo and
coal find by iteration [m]."""
REACH, WORDS = 1e-9, 1e-5
"""Tolerances of how far a mesh reaches [m]: against MuJoCo's vertices, and against those of the
files, which MuJoCo keeps in single precision."""
EXACT = ("Sphere", "Capsule")
FARTHEST, PAIRS = 10.0, 12
"""Distances up to which MuJoCo looks [m], and pairs of shapes of a model that are compared."""


class Differences(NamedTuple):
    """Largest differences of a model from MuJoCo's."""

    n_v: int
    shapes: int
    ignored: int
    mass: float
    pose: float
    jacobian: float
    inertia: float
    distance: float
    curved: float


class Reaches(NamedTuple):
    """Largest differences of how far the meshes of a model reach [m]: from what, and how much."""

    mujoco: float
    words: float


def error(a: Array, b: Array) -> float:
    """Largest difference of two arrays, over the largest entry of the second."""
    return float(np.abs(a - b).max(initial=0.0) / (np.abs(b).max(initial=0.0) or 1.0))


def system_of(path: Path) -> tuple[System, Any]:
    """An MJCF file as a system of one body, all actuated, and as MuJoCo's model."""
    model = mujoco.MjModel.from_xml_path(str(path))
    base = "floating" if (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any() else "fixed"
    text = mjcf_urdf(path, base)
    body = Body("r", text, base, "all")
    return System([body]), model


def mujoco_qpos(system: System, model: Any, q: Array) -> tuple[Array, Array]:
    """MuJoCo's qpos of a configuration q, and T with its qvel = T delta_q."""
    qpos = model.qpos0.copy()
    T = np.zeros((model.nv, system.n_v))
    names = Names.of(model).joints
    for joint in system.joints:
        own = joint.name.partition("/")[2]
        i = 0 if own == "base" else names.index(own)
        at = model.jnt_qposadr[i]
        dof = model.jnt_dofadr[i]
        x = q[joint.q]
        if (
            own == "base"
        ):  # a twist in the body's frame; MuJoCo's velocity is along the world's axes
            qpos[at : at + 7] = x[[0, 1, 2, 6, 3, 4, 5]]
            R = system.kinematics(q).R[system.link("r")]
            T[dof : dof + 3, joint.v][:, :3], T[dof + 3 : dof + 6, joint.v][:, 3:] = R, np.eye(3)
        else:
            qpos[at] += x[0] if len(x) == 1 else np.arctan2(x[1], x[0])
            T[dof, joint.v] = 1.0
    return qpos, T


def differences(path: Path, count: int, seed: int = 0) -> Differences:
    """What a file, read here, differs from MuJoCo in at random configurations."""
    system, model = system_of(path)
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    bodies = Names.of(model).bodies
    links = [system.links.index(f"r/{b}") if f"r/{b}" in system.links else 0 for b in bodies]
    numbers = {i: link for i, link in enumerate(links) if link}
    mass = max(abs(system.masses[k] - model.body_mass[i]) for i, k in numbers.items())
    pairs = shape_pairs(system, model, numbers, rng)
    worst = np.zeros(5)
    for _ in range(count):
        q = system.integrate(system.q_start, rng.normal(scale=0.5, size=system.n_v))
        qpos, T = mujoco_qpos(system, model, q)
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        kinematics = system.kinematics(q)
        pose = 0.0
        jacobian = 0.0
        M = np.zeros((system.n_v, system.n_v))
        for i, k in numbers.items():
            R = kinematics.R[k]
            J = kinematics.J[k]
            pose = max(pose, np.abs(kinematics.t[k] - data.xpos[i]).max(),
                       np.abs(R - data.xmat[i].reshape(3, 3)).max())  # fmt: skip
            own = np.zeros((2, 3, model.nv))
            mujoco.mj_jacBody(model, data, own[0], own[1], i)
            jacobian = max(jacobian, error(J, np.vstack(own) @ T))
            arm = R @ system.centres[k]
            linear = J[:3] - np.cross(arm, J[3:], axisb=0, axisc=0)
            M += system.masses[k] * linear.T @ linear
            M += J[3:].T @ R @ system.inertias[k] @ R.T @ J[3:]
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        inertia = error(M, T.T @ (full - np.diag(model.dof_armature)) @ T)
        near = 0.0
        curved = 0.0
        for pair, g, other in pairs:
            apart = mujoco.mj_geomDistance(model, data, g, other, FARTHEST, None)
            exact = {type(s.shape).__name__ for s in (pair.alpha, pair.beta)} <= set(EXACT)
            if not exact and apart <= 0:
                continue  # a rail through a box is as deep as its radius there
            try:
                off = abs(float(closest_points([pair], kinematics).phi[0]) - apart)
            except ContactError:  # neighbours that cross at a joint have no normal
                continue
            near, curved = (max(near, off), curved) if exact else (near, max(curved, off))
        worst = np.maximum(worst, [pose, jacobian, inertia, near, curved])
    return Differences(system.n_v, len(system.shapes), len(system.ignored), mass, *worst.tolist())


def reaches(path: Path, points: Mapping[str, Array], seed: int = 0) -> Reaches:
    """How far meshes reach from the origins of their bodies, against MuJoCo and their own points.

    Parameters
    ----------
    path : Path
    points : mapping of str to ndarray, shape (N, 3)
        Those of geoms, in the frame of their body [m].
    seed : int
    """
    system, model = system_of(path)
    directions = np.random.default_rng(seed).normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    worst = np.zeros(2)
    for placed in system.shapes:
        name = placed.name.partition("/")[2]
        geom = model.geom(name)
        mesh = model.mesh(int(geom.dataid[0]))
        first = int(mesh.vertadr[0])
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, geom.quat)
        compiled = model.mesh_vert[first : first + int(mesh.vertnum[0])] @ R.reshape(3, 3).T
        here = placed.shape.support_value(directions @ placed.R) + directions @ placed.t
        own = (directions @ (compiled + geom.pos).T).max(axis=1)
        worst[0] = max(worst[0], np.abs(here - own).max())
        if name in points:
            words = (directions @ points[name].T).max(axis=1)
            worst[1] = max(worst[1], np.abs(here - words).max())
    return Reaches(*worst.tolist())


class Tried(NamedTuple):
    """What random models came to."""

    right: int
    refused: list[str]
    wrong: list[int]
    reach: float
    words: float
    rest: float
    kinds: Counter[str]


def random_models(seeds: Iterable[int]) -> Tried:
    """Random models of meshes: right, or refused in words, or wrong."""
    right = 0
    refused = []
    wrong = []
    worst = np.zeros(3)
    kinds = Counter()
    for seed in seeds:
        with tempfile.TemporaryDirectory() as folder:
            made = random_model(Path(folder), seed)
            kinds.update(made.kinds)
            try:
                far = reaches(made.path, made.points)
            except ModelError as refusal:
                refused.append(f"{seed}: {refusal}")
                continue
            rest = max(differences(made.path, 1)[3:7])
        worst = np.maximum(worst, [*far, rest])
        if far.mujoco <= REACH and far.words <= WORDS and rest <= SAME:
            right += 1
        else:
            wrong.append(seed)
    return Tried(right, refused, wrong, *worst.tolist(), kinds)


def shape_pairs(
    system: System, model: Any, numbers: dict[int, int], rng: np.random.Generator
) -> list[tuple[ContactPair, int, int]]:
    """Some pairs of shapes of two links, and MuJoCo's numbers of their geoms."""
    touches = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    geoms = {}
    for g in np.flatnonzero(touches & (model.geom_type > 1)):
        geoms.setdefault(numbers.get(int(model.geom_bodyid[g]), -1), []).append(int(g))
    number = {id(s): geoms[s.link].pop(0) for s in system.shapes}
    every = [(a, b) for i, a in enumerate(system.shapes) for b in system.shapes[i + 1 :]]
    every = [(a, b) for a, b in every if a.link != b.link]
    chosen = rng.permutation(len(every))[:PAIRS]
    return [
        (ContactPair("p(a, b)", a, b, 0.0, 0.0, 4, 1, hull=True), number[id(a)], number[id(b)])
        for a, b in (every[i] for i in chosen)
    ]
