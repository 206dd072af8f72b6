"""A MuJoCo model as a system: its kinematics, masses, forces and closest points at any q."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from threading import RLock
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.jacobian import columns_at
from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.model.joints.axis_joint import Prismatic, Revolute
from quasistatic_ref.model.joints.ball import Ball
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.state import State
from quasistatic_ref.numbers.arrays import Array, Indices, with_shape
from quasistatic_ref.numbers.ordered import rotated
from quasistatic_ref.optional.extensions.extension import Extension
from quasistatic_ref.optional.mujoco import constraints
from quasistatic_ref.optional.mujoco.fates import check, check_run, kind_of, named
from quasistatic_ref.optional.mujoco.loads import (
    Spring,
    check_stiff,
    diagonal_of_H,
    disabled,
    loads,
    passive_springs,
    stiffness,
)
from quasistatic_ref.optional.mujoco.mujoco import actuated, joint_friction
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState, Natural, mujoco_state
from quasistatic_ref.optional.mujoco.places import Places
from quasistatic_ref.optional.mujoco.tolerances import FULL_RANK
from quasistatic_ref.solve.by_group import coordinate_units
from quasistatic_ref.step.data import Extra
from quasistatic_ref.tolerances import FILLED

if TYPE_CHECKING:
    from mujoco import MjData, MjModel

KINDS: dict[str, tuple[type[Joint], list[int]]] = {
    "FREE": (Floating, [0, 1, 2, 4, 5, 6, 3]),
    "BALL": (Ball, [1, 2, 3, 0]),
    "SLIDE": (Prismatic, [0]),
    "HINGE": (Revolute, [0]),
}
"""Joints by MuJoCo's types, and where in its entries of qpos those of q are."""
NOTHING = '<robot name="mujoco"><link name="body"/></robot>'
"""In place of the URDF of a body, whose visual elements a page would show."""
ELSEWHERE = 0.1
"""How far from the start springs are looked at once more [m, rad]."""


class Velocities(JacobianColumns):
    """Which of MuJoCo's velocities move a body, and with which coordinates.

    Parameters
    ----------
    moves : ndarray, shape (L, 1, nv)
        1 where a velocity moves a body [-].
    T : ndarray, shape (nv, n_v)
        MuJoCo's displacement, per unit of the coordinates of a step [-].
    """

    def __init__(self, moves: Array, T: Array) -> None:
        super().__init__(moves, np.abs(T).argmax(axis=1), T.shape[1])
        self.T = T

    @property
    def shares(self) -> tuple[Indices, Indices, Array]:
        """The entries of T that are not zero, with their rows and columns, (k,) each [-]."""
        x, v = np.nonzero(self.T)
        return x, v, self.T[x, v]

    def of_coordinates(self, columns: Array) -> Array:
        """`columns` of MuJoCo's velocities, (..., nv), per unit of delta_q, (..., n_v) [m, rad]."""
        per_unit: Array = columns @ self.T
        return per_unit


@dataclass(frozen=True, eq=False)
class Placed(Kinematics):
    """Where every body is, how it moves, and the contacts of all pairs.

    Parameters
    ----------
    points : ClosestPoints, optional
    """

    points: ClosestPoints | None = None


class MujocoSystem(Mechanism):
    """A MuJoCo model behind the names of a :class:`.Mechanism`.

    Links are MuJoCo's bodies, ``TREE/BODY``, bodies the trees of the world. Coordinates are
    MuJoCo's velocities, without those that equalities of joints take away, the actuated ones first:
    of a free joint along the world's axes and about the body's own. q has the same order, and
    quaternions [x y z w]. Forces of servos and springs are K_q (q_bar_a - q_a): where a servo's
    force is at the end of its range, a target is no farther than that force reaches. Motors are
    external forces.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Where a run starts; neither is changed. Bodies with ``mocap`` and applied forces stay.
    h : float
        Time step, for natural units [s].
    stiffnesses : mapping of str to float
        Of springs towards targets of joints [N/m, N m/rad].
    margin : float
        Gap up to which MuJoCo looks for contacts [m].

    Attributes
    ----------
    K_q : ndarray, shape (n_a, n_a)
    places : Places
        What may touch.
    springs : tuple of Spring
    driven : dict of str to Spring
        Those towards targets of joints.
    driven_entries : list of int
        Where the positions of these joints stand in qpos.
    rises : Rises
        Friction of joints.
    turn : RLock
        Held by who reads a state.

    Raises
    ------
    ModelError
        Naming element and field of what no run can say.
    """

    of_mjcf = True
    constant_mass_matrix = False
    mass_entries = None

    def __init__(
        self, model: MjModel, data: MjData, h: float, stiffnesses: Mapping[str, float],
        margin: float,
    ) -> None:  # fmt: skip
        self.model = copy.copy(model)
        self.start = copy.copy(data)
        self.h = h
        self._arguments = self.model, self.start, h, {**stiffnesses}, margin
        self._at: bytes | None = None
        self.turn = RLock()
        state = self._state = mujoco_state(self.model, self.start)
        check(state)
        check_run(state)
        self.places = Places(state, margin)
        self.margins = self.places.margins
        self.layout = contact_layout(self.places.pairs)
        state.run()
        self.driven = {name: self._driven_spring(name, k) for name, k in stiffnesses.items()}
        self.driven_entries = [int(self.model.joint(name).qposadr[0]) for name in stiffnesses]
        self.springs = self._springs()
        check_stiff(self.springs)
        of_state = loads(state)
        tied = constraints.tied_joints(state, diagonal_of_H(self.springs, state.M, h))
        self._follow = constraints.followers(state, tied)
        self._tied, n_a, self.K_q = actuated(state, self.springs, tied)
        self.T = self._tied.T
        trees = self._trees()
        joints, self._entries = self._joints(trees, n_a)
        turns = np.zeros((model.nbody, 9))
        for turn, quaternion in zip(turns, model.body_iquat, strict=True):
            state.mujoco.mju_quat2Mat(turn, quaternion)
        axes = turns.reshape(-1, 3, 3)
        roots = {trees[i]: i for i in range(1, model.nbody) if not model.body_parentid[i]}
        moving = {joint.name.partition("/")[0] for joint in joints}
        names = [state.name("body", i) or f"body{i}" for i in range(model.nbody)]
        super().__init__(
            bodies=tuple(Body(tree, NOTHING) for tree in roots if tree in moving),
            joints=joints,
            links=("world", *(f"{trees[i]}/{names[i]}" for i in range(1, model.nbody))),
            roots=roots,
            shapes=tuple(shape for shape in self.places.shapes.values() if shape.link),
            masses=model.body_mass.copy(),
            centres=model.body_ipos.copy(),
            inertias=axes * model.body_inertia[:, None] @ axes.transpose(0, 2, 1),
            q_start=state.data.qpos[self._entries],
            ignored=of_state.left_out,
        )
        self.column_map = Velocities(self._moves(), self.T)
        diagonal = np.concatenate([h * np.diag(self.K_q), np.diag(self.M_u(self.q_start)) / h])
        self.scale = Natural(state, self.T, coordinate_units(diagonal))
        self.rises, _ = joint_friction(state, self.T, h * diagonal)
        self.rows = self._rows(self.state(self.q_start))
        self._check_constant()

    def __reduce__(self) -> Any:
        return MujocoSystem, self._arguments

    def _springs(self) -> tuple[Spring, ...]:
        """All springs and servos at the state, saturated ones too."""
        state = self._state
        servos = (
            Spring(named(state, "actuator_biasprm", i), stiffness(state, i), state.moments[i])
            for i in self.servos
        )
        return (*passive_springs(state), *servos, *self.driven.values())

    @property
    def servos(self) -> list[int]:
        """The actuators whose force falls with their length."""
        state = self._state
        return [i for i in range(self.model.nu) if stiffness(state, i) and not disabled(state, i)]

    @property
    def integrators(self) -> list[int]:
        """The actuators whose activation is the integral of their control."""
        kinds = [kind_of(self._state, "actuator_dyntype", i) for i in range(self.model.nu)]
        return [i for i, kind in enumerate(kinds) if kind == "INTEGRATOR"]

    def _driven_spring(self, name: str, k: float) -> Spring:
        """The spring of a hinge or slide towards its targets."""
        state = self._state
        j = state.mujoco.mj_name2id(self.model, state.mujoco.mjtObj.mjOBJ_JOINT, name)
        if j < 0 or kind_of(state, "jnt_type", j) not in ("HINGE", "SLIDE"):
            raise ModelError("must be a hinge or slide of the model", field="joint", value=name)
        dof = int(self.model.jnt_dofadr[j])
        if any(state.moments[i, dof] for i in self.servos):
            problem = "has a servo; name that in the table of targets instead"
            raise ModelError(problem, field=f"stiffness.{name}", value=k)
        return Spring(f"stiffness.{name}", float(k), np.eye(self.model.nv)[dof])

    def _trees(self) -> list[str]:
        """The tree of each body by its name, which no other tree has."""
        state, model = self._state, self.model
        names = ["world"]
        for body in range(1, model.nbody):
            if model.body_parentid[body]:
                names.append(names[model.body_parentid[body]])
                continue
            name = state.name("body", body) or f"body{body}"
            name = "".join("_" if c in "/#*" or c.isspace() else c for c in name)
            names.append(f"{name}_{body}" if name in names else name)
        return names

    def _joints(self, trees: list[str], n_a: int) -> tuple[tuple[Joint, ...], Indices]:
        """Joints, in the order of their coordinates, and where their entries of qpos are."""
        state, model = self._state, self.model
        joints: list[Joint] = []
        entries: list[int] = []
        v = 0
        while v < len(self._tied.dofs):
            j = int(model.dof_jntid[self._tied.dofs[v]])
            kind, places = KINDS[kind_of(state, "jnt_type", j)]
            first = len(entries)
            entries += [int(model.jnt_qposadr[j]) + i for i in places]
            n = max(1, len(places) - 1)
            name = "base" if kind is Floating else state.name("joint", j) or f"joint{j}"
            ends = tuple(model.jnt_range[j].tolist()) if model.jnt_limited[j] and n == 1 else None
            at = slice(first, len(entries)), slice(v, v + n)
            joints.append(kind(f"{trees[model.jnt_bodyid[j]]}/{name}", v < n_a, *at, ends))
            v += n
        return tuple(joints), np.array(entries)

    def _moves(self) -> Array:
        """1 where one of MuJoCo's velocities moves a body, shape (L, 1, nv)."""
        model = self.model
        moves = np.zeros((model.nbody, 1, model.nv))
        for body in range(1, model.nbody):
            moves[body] = moves[model.body_parentid[body]]
            first = model.body_dofadr[body]
            moves[body, 0, first : first + model.body_dofnum[body]] = 1.0
        return moves

    def _check_constant(self) -> None:
        """Refuse springs whose gradient depends on q: K_q is that of the whole run."""
        away = np.where(np.arange(self.n_v) % 2, -ELSEWHERE, ELSEWHERE)
        self.state(self.integrate(self.q_start, away))
        for then, now in zip(self.springs, self._springs(), strict=True):
            if np.abs(now.m - then.m).max() > FULL_RANK * np.abs(then.m).max():
                problem = "pulls along a length whose gradient changes with q, and K_q is that of "
                problem += "the whole run; a run has springs of joints and of fixed tendons"
                raise ModelError(problem, field=then.field)

    def qpos(self, q: ArrayLike) -> Array:
        """MuJoCo's configuration at q, shape (nq,) [m, rad, -]."""
        qpos: Array = self.start.qpos.copy()
        qpos[self._entries] = q
        for _ in self._follow:  # one may follow another
            for first, second, (a, b) in self._follow:
                along = qpos[second] - self.model.qpos0[second] if second >= 0 else 0.0
                qpos[first] = self.model.qpos0[first] + a + b * along
        return qpos

    def state(self, q: ArrayLike) -> MujocoState:
        """MuJoCo's state at q, at rest; the same object at every q, to be read in ``turn``."""
        here = with_shape(q, "q", (self.n_q,), ModelError)
        bits = here.tobytes()
        if self._at != bits:
            self.units.check(here)
            self._at = None
            self._state.data.qpos[:] = self.qpos(here)
            self._state.data.ctrl[:] = self.start.ctrl
            self._state.run()
            self._at = bits
        return self._state

    def _state_at(self, q: Array) -> SceneState:
        """The state at a q, (n_q,) [m, rad, -], that has been checked."""
        return SceneState(self, q)

    def freed(self, points: ClosestPoints, columns: Array) -> ClosestPoints:
        """The same contacts, except that a contact that nothing can open bears no load.

        Its bodies are in each other, and no joint moves them along its normal.

        Parameters
        ----------
        points : ClosestPoints
        columns : ndarray, shape (6, nv)
            Of MuJoCo's velocities [m, rad].
        """
        deep = np.flatnonzero(points.phi < 0)
        if not len(deep):
            return points
        n = points.n[deep]
        links = np.stack([self.layout.link_alpha[deep], self.layout.link_beta[deep]])
        of_sides = columns_at(columns, np.array([points.alpha[deep], points.beta[deep]]), n)
        of_alpha, of_beta = (self.column_map.moves[links] * of_sides)[:, :, :3]
        held = deep[self.scale.empty(np.einsum("jc,jci->ji", n, of_beta - of_alpha))]
        phi = points.phi.copy()
        phi[held] = FILLED
        return points._replace(phi=phi)

    def _rows(self, state: MujocoState) -> Extra:
        """Limits, and equalities that take no coordinate away."""
        held = constraints.equalities(state, self._tied, self.scale, as_is=True)
        limits, _ = constraints.limits(state, self.scale, held.basis, as_is=True)
        return constraints.extra_of([*limits, *held.rows], self.n_v)

    def extension(self, q: Array) -> Extension:
        """Limits, equalities and joint friction at q."""
        with self.turn:
            return Extension(rows=self._rows(self.state(q)), rises=self.rises)

    def difference(self, q: ArrayLike, q_next: ArrayLike) -> Array:
        """Change delta_q = q_next (-) q by ``mj_differentiatePos``, shape (n_v,)."""
        change = np.zeros(self.model.nv)
        here, there = self.qpos(q), self.qpos(q_next)
        self._state.mujoco.mj_differentiatePos(self.model, change, 1.0, here, there)
        return np.asarray(change[self._tied.dofs])

    def _centre(self, name: str, link: int) -> Array:
        """Where a load acts by default, (3,) [m], in the frame of a body of MuJoCo that moves."""
        if name not in self._roots:
            return np.asarray(self.centres[link])
        weld = self.model.body_weldid
        at = self.kinematics(self.q_start)
        welded = weld == weld[link]
        places = rotated(at.R[welded], self.centres[welded]) + at.t[welded]
        centre = np.average(places, axis=0, weights=self.masses[welded])
        return np.asarray(at.R[link].T @ (centre - at.t[link]))


class SceneState(State):
    """A MuJoCo scene at one configuration."""

    system: MujocoSystem

    @cached_property
    def kinematics(self) -> Placed:
        """Pose and Jacobian of every body, and the closest points."""
        system = self.system
        with system.turn:
            state = system.state(self.q)
            data, model = state.data, system.model
            omega, along = data.cdof[:, :3], data.cdof[:, 3:]  # about the centre of the tree
            centre = data.subtree_com[model.body_rootid[model.dof_bodyid]]
            columns = np.concatenate([(along - np.cross(omega, centre)).T, omega.T])
            R, t = data.xmat.reshape(-1, 3, 3).copy(), data.xpos.copy()
            points = system.freed(system.places.points(state), columns)
        return Placed(R, t, columns, system.column_map, points)

    @cached_property
    def M_u(self) -> Array:
        """Un-actuated block of the mass matrix, with armatures, shape (n_u, n_u)."""
        T_u = self.system.T[:, self.system.n_a :]
        with self.system.turn:
            M = T_u.T @ self.system.state(self.q).M @ T_u
        symmetric: Array = (M + M.T) / 2
        return symmetric

    def gravity(self, acceleration: ArrayLike) -> Array:
        """All forces but those of springs and actuators, shape (n_v,) [N, N m].

        Gravity is the model's; `acceleration`, shape (3,) [m/s^2], is not read.
        """
        with self.system.turn:
            data = self.system.state(self.q).data
            smooth = data.qfrc_smooth - data.qfrc_actuator - data.qfrc_spring
        return np.asarray(self.system.T.T @ smooth + 0.0)

    def change_to(self, q_a: ArrayLike) -> Array:
        """Change of the actuated coordinates to a target, shape (n_a,)."""
        system = self.system
        system.actuated_units.check(np.asarray(q_a))
        return system.difference(self.q, system.with_actuated(self.q, q_a))[: system.n_a]

    def plus(self, delta_q: ArrayLike) -> SceneState:
        """The state at q (+) delta_q by ``mj_integratePos``, of a change of shape (n_v,)."""
        system = self.system
        change = with_shape(delta_q, "delta_q", (system.n_v,), ModelError)
        qpos = system.qpos(self.q)
        system._state.mujoco.mj_integratePos(system.model, qpos, system.T @ change, 1.0)
        return SceneState(system, qpos[system._entries])
