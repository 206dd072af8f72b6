"""A state of MuJoCo as a step: what MuJoCo says of it, without its velocity and its softness.

No geometry is translated. Contacts, frames, friction, Jacobians, masses and forces are MuJoCo's.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, ModelError
from quasistatic_ref.numbers.arrays import Array, freeze_copies
from quasistatic_ref.optional.extensions.extension import Rises
from quasistatic_ref.optional.extensions.rises import LIGHT
from quasistatic_ref.optional.mujoco import constraints, touches
from quasistatic_ref.optional.mujoco.fates import check, kind_of
from quasistatic_ref.optional.mujoco.loads import Spring, diagonal_of_H, loads
from quasistatic_ref.optional.mujoco.mujoco_state import (
    MujocoState,
    Natural,
    mujoco_state,
    product_with_zeros,
)
from quasistatic_ref.optional.mujoco.tolerances import DEEP, FULL_RANK
from quasistatic_ref.parts import needing
from quasistatic_ref.solve.by_group import coordinate_units
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.data import Extra, StepData, seconds
from quasistatic_ref.text.module_on_demand import ModuleOnDemand
from quasistatic_ref.text.plain import Plain

if TYPE_CHECKING:
    import mujoco
else:
    mujoco = ModuleOnDemand("mujoco")

DEPTHS = ("closed", "as is")
AXES = {"FREE": ("x", "y", "z", "rx", "ry", "rz"), "BALL": ("rx", "ry", "rz")}
"""Coordinates of a joint: of a free one, along the world's axes and about the body's own."""


@dataclass(frozen=True, eq=False)
class Coordinates(Plain):
    """Where the coordinates of a step are in MuJoCo, and what the step leaves out.

    Parameters
    ----------
    names : tuple of str, length n_v
        ``joint[knee]``, ``joint[cap].rx``, ``friction of joint[knee]``.
    T : ndarray, shape (nv, n_v)
        MuJoCo's displacement, per unit of delta_q [-]: what ``mj_integratePos`` takes is T delta_q,
        with dt = 1.
    left_out : tuple of str
        What the step does not have, or holds as it is: one sentence for each.
    quasi_dynamic_number : float
        Largest v / (mu_v g h) of the contacts with friction, of the speed v that was dropped [-]:
        the drag of the model on that motion, over the friction. It is inf without gravity.
    """

    names: tuple[str, ...]
    T: Array
    left_out: tuple[str, ...]
    quasi_dynamic_number: float

    def __post_init__(self) -> None:
        freeze_copies(self, "T")


def mujoco_step(
    model: mujoco.MjModel, data: mujoco.MjData, h: float, depth: str = "closed"
) -> tuple[StepData, Coordinates]:
    """The step that begins in a state of MuJoCo, at rest.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Neither is changed. Its velocity is dropped.
    h : float
        Time step [s].
    depth : str
        ``"closed"``: contacts, limits and equalities that are violated count as closed.
        ``"as is"``: one step closes them.

    Returns
    -------
    StepData
        In the ellipsoid if the model's cone is elliptic, a contact rubs, and no row is an
        equality's.
    Coordinates

    Raises
    ------
    InputError
        If `depth` is another word.
    ModelError
        Naming element and field of what no step can say.

    Examples
    --------
    >>> import mujoco
    >>> ball = '<body pos="0 0 0.1"><freejoint/><geom name="ball" size="0.1" mass="0.3"/></body>'
    >>> floor = '<geom name="floor" type="plane" size="1 1 1"/>'
    >>> text = f"<mujoco><worldbody>{floor}{ball}</worldbody></mujoco>"
    >>> model = mujoco.MjModel.from_xml_string(text)
    >>> step, coordinates = qr.mujoco_step(model, mujoco.MjData(model), h=0.01)
    >>> step.contacts.name, coordinates.names[2]
    (('0: floor/ball',), 'joint[0].z')
    >>> qr.solve_step(step).forces[0, 2].round(3)  # the weight [N]
    np.float64(2.943)
    """
    return step_with(model, data, h, depth)


def step_with(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    h: float,
    depth: str,
    drag: Array | float = 0.0,
    hops: Collection[tuple[int, int]] = (),
) -> tuple[StepData, Coordinates]:
    """The step of :func:`mujoco_step` under a further load, `drag` (nv,) or 0 [N, N m].

    Pairs of geoms that hop count as touching.

    Raises
    ------
    InputError, ModelError
        As of :func:`mujoco_step`.
    """
    if depth not in DEPTHS:
        raise InputError(f"must be one of {DEPTHS}", field="depth", value=depth)
    h = seconds(h)
    as_is = depth == "as is"
    state = mujoco_state(model, data, hops)
    check(state)
    state.run()
    of_state = loads(state)
    every_joint = constraints.Tied(np.arange(model.nv), np.eye(model.nv), ())
    heavy = diagonal_of_H(of_state.springs, state.M, h)
    tied = every_joint if as_is else constraints.tied_joints(state, heavy)
    tied, n_a, K_q = actuated(state, of_state.springs, tied)
    T = tied.T
    M_u = T[:, n_a:].T @ state.M @ T[:, n_a:]
    diagonal = np.concatenate([h * np.diag(K_q), np.diag(M_u) / h])
    scale = Natural(state, T, coordinate_units(diagonal))
    held = constraints.equalities(state, tied, scale, as_is)
    limits, free_limits = constraints.limits(state, scale, held.basis, as_is)
    every = touches.contacts(state)
    free = touches.held(every, scale, held.basis)
    kept = [contact for contact, is_free in zip(every, free, strict=True) if not is_free]
    contacts = touches.step_contacts(kept, T, as_is)
    tau = T.T @ (of_state.others + drag)
    rows = [row for row in (*limits, *held.rows) if row.holds]
    extra = constraints.extra_of(rows, T.shape[1])
    cone, notes = default_cone(model, any(contact.mu_v for contact in every), extra)
    step = StepData(
        h=h,
        K_q=K_q,
        M_u=(M_u + M_u.T) / 2,
        tau_a=tau[:n_a],
        tau_u=tau[n_a:],
        delta_q_bar_a=np.linalg.solve(K_q, (T.T @ of_state.of_springs)[:n_a]),  # Eq. (1)
        contacts=contacts,
        cone=cone,
        extra=extra,
    )
    left_out = (
        *of_state.left_out, *held.left_out, *free_limits,
        *(f"contact[{every[i].name}]: {touches.HELD}" for i in np.flatnonzero(free)),
        *(f"contact[{one.name}]: {touches.ROLLS}" for one in every if one.rolls),
        *dropped(data.qvel, every), *notes,
    )  # fmt: skip
    rises, rubbed = joint_friction(state, T, h * diagonal)
    if rubbed:
        with needing("frictionloss"):
            from quasistatic_ref.optional.extensions.rises import with_rises
        step = with_rises(step, rises)
    names = (*(coordinate_name(state, dof) for dof in tied.dofs.tolist()), *rubbed)
    T = np.pad(T, ((0, 0), (0, len(rubbed))))
    number = touches.quasi_dynamic_number(every, data.qvel, model.opt.gravity, h)
    return step, Coordinates(names, T, left_out, number)


def dropped(v: Array, every: Sequence[touches.StateContact]) -> Iterator[str]:
    """What any step leaves out: a velocity v, (nv,), and the depth of bodies in each other."""
    for contact in every:
        if contact.distance < -DEEP:
            depth = f"its bodies penetrate by {-1e3 * contact.distance:.3g} mm"
            yield f"contact[{contact.name}]: {depth}"
    if v.any():
        yield f"velocity: dropped; its largest component is {np.abs(v).max():.2g}"


def actuated(
    state: MujocoState, springs: Sequence[Spring], tied: constraints.Tied
) -> tuple[constraints.Tied, int, Array]:
    """The joints that remain, the n_a actuated ones first, n_a, and K_q, shape (n_a, n_a).

    A coordinate is actuated if a servo or spring acts on it.

    Raises
    ------
    ModelError
        Naming a servo or spring that leaves others of its coordinates free: K_q is singular.
    """
    moments = [product_with_zeros(state, spring.m[None], tied.T)[0] for spring in springs]
    K = np.zeros((len(tied.dofs),) * 2)
    for spring, m in zip(springs, moments, strict=True):
        K += spring.k * np.outer(m, m)
    a = np.flatnonzero(K.any(axis=1))
    u = np.setdiff1d(np.arange(len(K)), a)
    K_q = K[np.ix_(a, a)]
    unit = 1 / np.sqrt(np.diag(K_q))
    values, vectors = np.linalg.eigh(unit[:, None] * K_q * unit)
    if values.min(initial=1.0) < FULL_RANK:
        free = np.abs(vectors[:, 0]) > FULL_RANK
        several = [s.field for s, m in zip(springs, moments, strict=True)
                   if np.count_nonzero(m[a][free]) > 1]  # fmt: skip
        problem = "acts on several joints, between which K_q leaves a motion without stiffness; "
        raise ModelError(problem + "give each of them a servo or a spring", field=several[0])
    order = np.concatenate([a, u])
    return tied._replace(dofs=tied.dofs[order], T=tied.T[:, order]), len(a), K_q


def default_cone(model: mujoco.MjModel, rubs: bool, extra: Extra) -> tuple[str, tuple[str, ...]]:
    """The cone of a model, which of its contacts rub, and a note where MuJoCo's differs."""
    if not (model.opt.cone and rubs):
        return PYRAMID, ()
    if equality := first_equality(extra):
        note = f'option.cone: elliptic; "pyramid" is taken, since {equality} is two rows, which '
        return PYRAMID, (f"{note}leave the ellipsoid no interior",)
    return ELLIPSOID, ()


def first_equality(extra: Extra) -> str:
    """The first equality among rows; empty if there is none."""
    names = (name.partition(" (")[0] for name in extra.names if name.startswith("equality"))
    return next(names, "")


def joint_friction(state: MujocoState, T: Array, heavy: Array) -> tuple[Rises, list[str]]:
    """What ``frictionloss`` appends to a step, and its names.

    Parameters
    ----------
    state : MujocoState
    T : ndarray, shape (nv, n)
        MuJoCo's displacement, per unit of the coordinates [-].
    heavy : ndarray, shape (n,)
        Diagonal of h H [kg, kg m^2].

    Raises
    ------
    ModelError
        Naming a tendon of several coordinates that has friction.
    """
    J, rows = state.rows("FRICTION_DOF", "FRICTION_TENDON")
    losses = state.data.efc_frictionloss[rows]
    numbers: list[int] = []
    loads_of_rises, names = [], []
    for row, along, loss in zip(
        rows.tolist(), product_with_zeros(state, J, T), losses.tolist(), strict=True
    ):
        on = np.flatnonzero(along).tolist()
        name = friction_name(state, row)
        if len(on) > 1:
            problem = "rubs along several joints at once, which no row expresses; leave it out"
            raise ModelError(problem, field=f"{name}.frictionloss", value=loss)
        for i in on:
            numbers.append(i)
            loads_of_rises.append(abs(along[i]) * loss)
            names.append(f"friction of {name}")
    rises = Rises(np.array(loads_of_rises), LIGHT * heavy[numbers], np.array(numbers))
    return rises, names


def friction_name(state: MujocoState, row: int) -> str:
    """The joint or tendon of a constraint of friction."""
    i = int(state.data.efc_id[row])
    if state.data.efc_type[row] == state.mujoco.mjtConstraint.mjCNSTR_FRICTION_TENDON:
        return state.words("tendon", i)
    return coordinate_name(state, i)


def coordinate_name(state: MujocoState, dof: int) -> str:
    """The name of one of MuJoCo's velocities, formed from its joint's."""
    joint = int(state.model.dof_jntid[dof])
    axes = AXES.get(kind_of(state, "jnt_type", joint))
    axis = f".{axes[dof - state.model.jnt_dofadr[joint]]}" if axes else ""
    return state.words("joint", joint) + axis
