"""What a step forms of closest points: source/step.c."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.normals import UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.configuration import UNIT_QUATERNION
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import System, SystemState
from quasistatic_ref.numbers.arrays import Array, read_only, with_shape
from quasistatic_ref.optional.compiled.addresses import addresses
from quasistatic_ref.optional.compiled.declared import ffi
from quasistatic_ref.optional.compiled.library import function
from quasistatic_ref.optional.compiled.sums import all_known, table
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, Sphere
from quasistatic_ref.simulate.form_step import StepBlock, StepPlan, checked_force
from quasistatic_ref.solve.by_group import layout_of
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.text.plain import bits

IN_C = (
    (1.0, 1.0, 0.0, 0.0),
    (1.0, 0.0, 1.0, 0.0),
    (1.0, -1.0, 0.0, 0.0),
    (1.0, 0.0, -1.0, 0.0),
    (1.0, 0.0, 0.0, 1.0),
    (1.0, 0.0, 0.0, -1.0),
)
"""Coefficients [-] of gap, slip_1, slip_2 and spin in the six rows of ``pyramid_rows``."""

Formed = Callable[[Kinematics, ClosestPoints, Array, Hessian], StepData | None]


def loads(plan: StepPlan) -> Callable[[State, ArrayLike, ArrayLike | None], Array | None] | None:
    """``StepPlan.loads`` in C, of pinocchio's systems, if it knows all of their joints.

    It declines angles that it cannot round, and parts not surely of length one. It returns an
    array of shape (n_v + n_a,), or None.
    """
    system = plan.system
    if not isinstance(system, System) or not all_known(system.actuated_sums):
        return None
    joints = system.actuated_sums.joints
    units = [joint.unit_part for joint in joints if joint.unit_vector]
    parts = [[unit.start for unit in units], [unit.stop - unit.start for unit in units]]
    sizes = np.array([system.n_v, system.n_a, len(joints), len(units)])
    fixed = sizes, table(system.actuated_sums), np.array(parts, np.int64)
    acts = plan.gravity_acts.astype(np.float64)
    kept = addresses((*fixed, system.column_map.order.v, acts))
    compiled = function("step_loads")
    down = tuple(plan.gravity.tolist())
    no_force = np.zeros(system.n_v)

    def answer(here: State, target: ArrayLike, force: ArrayLike | None) -> Array | None:
        assert isinstance(here, SystemState)
        tau = checked_force(system, force)
        q_a = with_shape(target, "q_a", (system.n_q_a,), ModelError)
        written = np.empty(system.n_v + system.n_a)
        read = here.gravity_torque(down), tau if tau.ndim else no_force, here.q, q_a
        answered = compiled(*kept, UNIT_QUATERNION**2 / 8, *addresses(read, (written,)))
        return read_only(written) if answered else None

    return answer


def trials_of_loads() -> list[tuple[StepPlan, tuple[Any, ...]]]:
    """Targets of a free base: a little away, as far around as can be, and where it is."""
    plan, here = _two_balls()
    n_q_a = plan.system.n_q_a
    numbers = np.sin(np.arange(1.0, 25.0))
    around = here.q[[0, 1, 2, 6, 5, 4, 3]]
    near = here.plus(numbers[:12] / 9).q[:n_q_a]
    targets = ((around, None), (near, numbers[12:]), (here.q[:n_q_a], None))
    return [(plan, (here, *target)) for target in targets]


def formed(plan: StepPlan) -> Formed | None:
    """``StepPlan.formed`` in C: in the pyramid, where each column belongs to one coordinate.

    It declines steps without load and penetration, and numbers that are not finite or leave
    float64's range.
    """
    geometry = plan.geometry
    if plan.cone != PYRAMID or geometry.sums or not geometry.joint.size:
        return None
    groups = plan.group_layout
    n_a, n_v = len(plan.K_q), geometry.n_v
    layout = plan.block_layout
    joint = geometry.joint
    moves = {name: moved[:, 0] for name, _, moved in geometry.sides}
    beta, alpha = (moves.get(name, np.zeros(joint.shape)) for name in ("beta", "alpha"))
    sizes = [*joint.shape, geometry.n_x, "beta" in moves, "alpha" in moves, *layout["b"][1], n_v]
    widest = max(len(group.coordinates) for group in groups.groups) if groups else 0
    fixed = np.array([*sizes, widest, n_a]), joint, beta, alpha
    kept = addresses((*fixed, geometry.mu, plan.row_layout.mask, plan.K_q))
    compiled = function("form_step")
    size = layout["units"][0].stop
    no_H = [ffi.NULL] * 4

    def answer(
        kinematics: Kinematics, points: ClosestPoints, loads: Array, hessian: Hessian
    ) -> StepData | None:
        if cone(PYRAMID).coefficients != IN_C:
            return None
        numbers = np.empty(size)
        phi, alpha, beta, n, point, _ = points
        of_step = kinematics.columns, loads, phi, alpha, beta, n
        of_H = no_H
        if groups is not None:
            H = hessian.once(groups.natural_hessian)
            of_H = addresses((H.own_unit, H.inverse, H.column, H.unit))
        if not compiled(*kept, plan.h, *addresses(of_step), *of_H, *addresses((), (numbers,))):
            return None
        return StepData.unchecked(
            hessian=hessian,
            extra=plan.no_extra,
            row_layout=plan.row_layout,
            formed=StepBlock(plan, read_only(numbers), point),
            **plan.fields(loads),
        )

    return answer


def _two_balls() -> tuple[StepPlan, State]:
    """Two balls on a floor and on each other, of which one is driven."""
    ball = Sphere(0.05)
    driven = Body.of_shape("a", ball, 0.3, actuated="all", xyz=(0, 0.01, 0.049))
    system = System([driven, Body.of_shape("b", ball, 0.2, xyz=(0.09, -0.02, 0.06))])
    floor = PlacedShape("floor", 0, np.eye(3), np.zeros(3), HalfSpace((0, 0, 1), 0.0))
    a, b = system.shapes
    rows = ((floor, a, 4), (floor, b, 6), (a, b, 6))
    pairs = tuple(ContactPair("p", one, other, 0.5, 0.01, count) for one, other, count in rows)
    K_q = np.diag(np.arange(100.0, 106.0))
    acts = np.arange(6) % 2 == 0
    plan = StepPlan(system, pairs, 0.01, K_q, np.array([0.1, 0.0, -9.81]), acts, PYRAMID)
    return plan, system.at(system.q_start).plus(np.sin(np.arange(1.0, 13.0)) / 10)


def trials_of_formed() -> list[tuple[StepPlan, tuple[Any, ...]]]:
    """Points that touch, and some that are inside."""
    plan, here = _two_balls()
    numbers = np.sin(np.arange(1.0, 40.0))
    alpha, beta = numbers[:18].reshape(2, 3, 3)
    n = np.array([[0.0, -0.0, 1.0], [0.6, -0.8, 0.0], [-0.36, -0.48, 0.8]])
    none = np.full(3, UNIQUE_NORMAL)
    points = ClosestPoints(numbers[18:21] / 100, alpha, beta, n, np.arange(3), none)
    hessian = Hessian(plan.h, plan.K_q, here.masses)
    return [(plan, (here.kinematics, points, read_only(numbers[21:39]), hessian))]


def bits_of_formed(step: StepData) -> Any:
    """Those of a step and of its program."""
    layout = layout_of(step)
    natural = NaturalStep(step, layout=layout)
    if isinstance(step.formed, StepBlock):
        natural = step.formed.natural(step, layout)
    return bits((step, natural.own_inequalities, natural.g, natural.units))
