"""A MuJoCo state at rest: what MuJoCo itself says of it once its velocity is zero, and its rows.

Where a contact is at the axis of the joint that moves its body, its normal row is zero but for
rounding, 1e-15 m/rad. As a row of a step it would bear any load, by a force of 1e15 times the load.
"""

from __future__ import annotations

import copy
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError, check_kind
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.mujoco.tolerances import FULL_RANK
from quasistatic_ref.parts import needed_package

if TYPE_CHECKING:
    from mujoco import MjData, MjModel

STAGES = ("mj_fwdPosition", "mj_fwdVelocity", "mj_fwdActuation", "mj_fwdAcceleration")
"""The stages of ``mj_forward`` before its solver."""
WIDE_MARGIN = 1e6
"""Margins of limits in the copy [m, rad]: all limits are rows."""
STATE = (
    "qpos", "qvel", "act", "ctrl", "qfrc_applied", "xfrc_applied", "mocap_pos", "mocap_quat",
)  # fmt: skip
"""What a user may set of a state."""
FULL = ("mjWARN_CONTACTFULL", "mjWARN_CNSTRFULL")


@dataclass(frozen=True, eq=False)
class MujocoState:
    """Private copies of a model and a state, at zero velocity, with all limits as rows.

    Parameters
    ----------
    mujoco : module
    model : mujoco.MjModel
        The user's.
    adapted : mujoco.MjModel
        The copy.
    data : mujoco.MjData
        The copy.
    hops : collection of tuple of int
        Pairs of geoms that count as touching, though they may have parted.
    """

    mujoco: ModuleType
    model: MjModel
    adapted: MjModel
    data: MjData
    hops: Collection[tuple[int, int]] = ()

    @property
    def M(self) -> Array:
        """The mass matrix, with armatures, shape (nv, nv)."""
        M = np.zeros((self.model.nv, self.model.nv))
        self.mujoco.mj_fullM(self.model, self.data, M)
        return M

    def jacobian(self, point: Array, body: int) -> Array:
        """Motion of a body's point, (3,) [m], and rotation along all velocities, (2, 3, nv)."""
        J = np.zeros((2, 3, self.model.nv))
        self.mujoco.mj_jac(self.model, self.data, *J, point, body)
        return J

    @property
    def moments(self) -> Array:
        """How the length of each actuator changes with the joints, shape (outputs, nv)."""
        data = self.data
        return self._dense(
            data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
        )

    @property
    def tendons(self) -> Array:
        """How the length of each tendon changes with the joints, shape (ntendon, nv)."""
        model = self.model
        return self._dense(
            self.data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind
        )

    @cached_property
    def reach(self) -> Array:
        """How far each velocity moves anything of its tree, per unit, (nv,) [m, or m/rad].

        MuJoCo has a velocity as a turn and a motion of the centre of mass of its tree.
        """
        model = self.model
        data = self.data
        trees = model.body_rootid
        places = np.concatenate([data.xpos, data.geom_xpos, data.site_xpos])
        radii = np.concatenate([np.zeros(model.nbody), model.geom_rbound, np.zeros(model.nsite)])
        of = trees[np.concatenate([np.arange(model.nbody), model.geom_bodyid, model.site_bodyid])]
        lever = np.zeros(model.nbody)
        np.maximum.at(lever, of, np.linalg.norm(places - data.subtree_com[of], axis=1) + radii)
        turn, motion = np.linalg.norm(data.cdof.reshape(-1, 2, 3), axis=2).T
        reached: Array = motion + turn * lever[trees[model.dof_bodyid]]
        return reached

    def run(self) -> None:
        """Run the stages of ``mj_forward``, from positions to forces.

        Raises
        ------
        ModelError
            If MuJoCo stops, or its memory does not hold all contacts and limits.
        """
        for warning in self.data.warning:
            warning.number = 0
        size = int(self.model.narena)
        try:
            for stage in STAGES:
                getattr(self.mujoco, stage)(self.adapted, self.data)
        except self.mujoco.FatalError as error:
            problem = f"may be too small: MuJoCo stops, {str(error).splitlines()[0]}"
            raise ModelError(problem, field="size.memory", value=size) from error
        if any(self.data.warning[getattr(self.mujoco.mjtWarning, name)].number for name in FULL):
            problem = 'does not hold all contacts and limits; set <size memory="100M"/>'
            raise ModelError(problem, field="size.memory", value=size)

    def rows(self, *kinds: str) -> tuple[Array, Indices]:
        """The Jacobians and numbers of MuJoCo's constraints of some kinds, (m, nv) and (m,)."""
        wanted = [int(getattr(self.mujoco.mjtConstraint, f"mjCNSTR_{kind}")) for kind in kinds]
        numbers = np.flatnonzero(np.isin(self.data.efc_type[: self.data.nefc], wanted))
        return self.data.efc_J.reshape(-1, self.model.nv)[numbers], numbers

    def words(self, kind: str, i: int) -> str:
        """An element in words, such as ``joint[knee]``; by its number if it has no name."""
        return f"{kind}[{self.name(kind, i) or i}]"

    def called(self, kind: str, i: int) -> str:
        """The name of an element, or its words."""
        return self.name(kind, i) or self.words(kind, i)

    def name(self, kind: str, i: int) -> str | None:
        """The name of an element, if it has one."""
        number = getattr(self.mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
        name: str | None = self.mujoco.mj_id2name(self.model, number, i)
        return name

    def disables(self, what: str) -> bool:
        """Whether the model switches something off, by the name of MuJoCo's flag."""
        flag = getattr(self.mujoco.mjtDisableBit, f"mjDSBL_{what}")
        return bool(self.model.opt.disableflags & flag)

    def _dense(self, values: Array, counts: Indices, starts: Indices, columns: Indices) -> Array:
        dense = np.zeros((len(counts), self.model.nv))
        if dense.size:
            self.mujoco.mju_sparse2dense(dense, values, counts, starts, columns)
        return dense


def awake(model: MjModel) -> MjModel:
    """A copy of a model in which nothing sleeps: what does has no contacts and does not move."""
    import mujoco

    adapted = copy.copy(model)
    adapted.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    return adapted


def check_finite(model: MjModel, data: MjData) -> None:
    """Refuse a model or a state that is not of finite numbers, which MuJoCo compiles.

    Raises
    ------
    ModelError
        Naming the field of ``MjModel`` or ``MjData``, or the time step.
    """
    h = model.opt.timestep
    if not 0 < h < np.inf:
        raise ModelError("must be a positive time [s]", field="option.timestep", value=h)
    for owner, what in ((model, "model"), (model.opt, "option")):
        for name in dir(owner):
            numbers = getattr(owner, name)
            is_float = isinstance(numbers, np.ndarray) and numbers.dtype.kind == "f"
            if is_float and not np.isfinite(numbers).all():
                raise ModelError("must contain finite numbers only", field=f"{what}.{name}")
    for name in STATE:
        if not np.isfinite(getattr(data, name)).all():
            raise ModelError("must contain finite numbers only", field=f"data.{name}")


def package_of(model: MjModel) -> ModuleType:
    """The package mujoco; InputError if `model` is no MjModel of it, but an MjSpec, a path, ..."""
    mujoco = needed_package("mujoco", "engines", "a MuJoCo scene")
    wanted = "a mujoco.MjModel"
    if isinstance(model, mujoco.MjSpec):
        wanted += ": spec.compile()"
    elif isinstance(model, str | PathLike):
        wanted += ": mujoco.MjModel.from_xml_path(file)"
    check_kind(model, mujoco.MjModel, "model", wanted)
    return mujoco


def mujoco_state(
    model: MjModel, data: MjData, hops: Collection[tuple[int, int]] = ()
) -> MujocoState:
    """Copies of a model and of its state at zero velocity, before ``run``.

    `hops` is as of :class:`MujocoState`.

    Raises
    ------
    ModelError
        If nothing in the model can move, or the state is not of finite numbers.
    """
    mujoco = package_of(model)
    check_kind(data, mujoco.MjData, "data", "a mujoco.MjData")
    check_finite(model, data)
    adapted = awake(model)
    adapted.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    adapted.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    for flag in ("IPC", "SPECULATIVE"):
        adapted.opt.enableflags &= ~int(getattr(mujoco.mjtEnableBit, f"mjENBL_{flag}"))
    adapted.jnt_margin[:] = WIDE_MARGIN  # a step may reach limits that are not near
    adapted.tendon_margin[:] = WIDE_MARGIN
    at_rest = copy.copy(data)
    at_rest.qvel[:] = 0.0
    state = MujocoState(mujoco, model, adapted, at_rest, hops)
    if not model.nv:
        bodies = [i for i in range(1, model.nbody) if model.body_mocapid[i] < 0]
        which = (
            f"put one into {state.words('body', bodies[0])}" if bodies else "add a body with one"
        )
        problem = f"has no joint that can move; {which}, such as <freejoint/>"
        raise ModelError(problem, field="worldbody")
    return state


def terms(state: MujocoState, J: Array, T: Array) -> Array:
    """Sums of the absolute terms of each entry of J T, shape (m, n): they bound its rounding.

    J has the shape (m, nv), and T the shape (nv, n) [-].
    """
    sizes: Array = np.maximum(np.abs(J), state.reach * (J != 0)) @ np.abs(T)
    return sizes


def product_with_zeros(state: MujocoState, J: Array, T: Array) -> Array:
    """J T, with zeros for the entries of which only rounding is left, shape (m, n).

    J has the shape (m, nv), and T the shape (nv, n) [-].
    """
    entries = J @ T
    return np.where(np.abs(entries) > FULL_RANK * terms(state, J, T), entries, 0.0)


class Natural(NamedTuple):
    """Natural units of rows, from a state and a basis of its coordinates.

    Parameters
    ----------
    state : MujocoState
    T : ndarray, shape (nv, n)
        MuJoCo's displacement, per unit of the coordinates of a step [-].
    units : ndarray, shape (n,)
        Diagonal of S of these coordinates [m or rad, per (N m s)^0.5].
    """

    state: MujocoState
    T: Array
    units: Array

    def rows(self, J: Array) -> Array:
        """Rows along MuJoCo's velocities, (m, nv), in natural units, (m, n)."""
        rows: Array = J @ self.T * self.units
        return rows

    def sizes(self, J: Array) -> Array:
        """The largest term of each row, shape (m,)."""
        sizes: Array = (terms(self.state, J, self.T) * self.units).max(axis=1, initial=0.0)
        return sizes

    def empty(self, J: Array, held: Array | None = None) -> Mask:
        """Which rows, (m, nv), are zero but for rounding, shape (m,): at most FULL_RANK of a term.

        `held`, shape (r, n) [-], are orthonormal rows, in natural units, along which nothing moves.
        """
        rows = self.rows(J)
        if held is not None:
            rows -= rows @ held.T @ held
        empty: Mask = np.abs(rows).max(axis=1, initial=0.0) <= FULL_RANK * self.sizes(J)
        return empty
