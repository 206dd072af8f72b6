"""A step in natural units: source/natural.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.certify.groups import Group, Groups
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.library import addresses, function
from quasistatic_ref.solve.by_group import GroupLayout, NaturalHessian, Programs
from quasistatic_ref.solve.units import Sizes
from quasistatic_ref.step.data import StepData, no_rows
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import Units


def step_sizes(_: None) -> Callable[[Array, Array, Array, NaturalHessian], Sizes | None]:
    """``step_sizes``; it declines numbers that are not finite."""
    compiled = function("step_sizes")

    def answer(A: Array, b: Array, g: Array, H: NaturalHessian) -> Sizes | None:
        written = np.empty(4)
        sizes = np.array([*A.shape, *H.inverse.shape])
        read = sizes, A, H.own_unit, b, g, H.inverse, H.column
        answered = compiled(*addresses(read, (np.empty(len(b)), written)))
        return Sizes(*written.tolist()) if answered else None

    return answer


def trials_of_step_sizes() -> list[tuple[None, tuple[Array, Array, Array, NaturalHessian]]]:
    """An even and an odd number of rows, of which some are zero."""
    numbers = np.sin(np.arange(1.0, 94.0))
    A, unit, b = numbers[:30].reshape(10, 3), numbers[30:60].reshape(10, 3), numbers[60:70]
    A = A * (numbers[60:70] < 0.9)[:, None]
    inverse, column = numbers[70:78].reshape(4, 2), np.array([[0, 3], [0, 3], [1, 4], [2, 4]])
    H = NaturalHessian(numbers[78:82], unit, [], inverse, column)
    g = numbers[82:86]
    return [(None, (A, b, g, H)), (None, (A[:7], -np.abs(b[:7]), g, H._replace(own_unit=unit[:7])))]


def programs(layout: GroupLayout) -> Callable[..., Programs | None]:
    """``GroupLayout.programs``; it declines rows of a user's own."""
    n, (m, w) = len(layout.coordinates), layout.column.shape
    sizes = np.array([n, m, w, layout.size])
    kept = addresses((sizes, layout.coordinates, layout.rows, layout.place))
    compiled = function("programs")

    def answer(step: StepData, A: Array, b: Array, g: Array, units: Units) -> Programs | None:
        if step.extra.names:
            return None
        H = layout.natural_hessian_of(step)
        g_of_all, A_of_all, b_of_all = written = np.empty(n), np.empty(layout.size + 1), np.empty(m)
        read = A, b, g, H.own_unit, units.coordinate, np.array(units[1:])
        compiled(*kept, *addresses(read, written))
        return Programs(layout, H.blocks, g_of_all, A_of_all[:-1], b_of_all)

    return answer


def trials_of_programs() -> list[tuple[GroupLayout, tuple[object, ...]]]:
    """Two groups, whose coordinates and rows stand between each other's."""
    index = [np.array(some, int) for some in ([0, 3], [0], [], [0, 1], [1, 2], [1], [], [2, 3, 4])]
    column = np.array([[0, 3, 4], [1, 2, 4]])
    every = Groups([Group(*index[:4]), Group(*index[4:])])
    layout = GroupLayout(every, column, np.array([2, 3]), 4, 0, 8)
    numbers = np.sin(np.arange(1.0, 25.0))
    A = numbers[:15].reshape(5, 3) * [1.0, 1.0, 0.0]
    step = StepData.unchecked(
        extra=no_rows(4), hessian=Hessian(0.5, np.eye(2), np.diag([3.0, 0.1]))
    )
    units = Units(layout.natural_hessian_of(step).unit, 0.125, 4.0)
    return [(layout, (step, A, numbers[15:20], numbers[20:], units))]
