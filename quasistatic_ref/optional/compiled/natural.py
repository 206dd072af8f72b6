"""A step in natural units: source/natural.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.certify.groups import Group, Groups
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.library import addresses, function
from quasistatic_ref.solve.by_group import GroupLayout, Programs
from quasistatic_ref.solve.units import Sizes
from quasistatic_ref.step.data import StepData, no_rows
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import Units


def row_sizes(_: None) -> Callable[[Array, Array, Array], Sizes | None]:
    """``row_sizes``; it declines numbers that are not finite."""
    compiled = function("row_sizes")

    def answer(A: Array, unit: Array, b: Array) -> Sizes | None:
        if A.shape != unit.shape:
            return None
        written = np.empty(3)
        read = np.array(A.shape), A, unit, b
        answered = compiled(*addresses(read, (np.empty(len(b)), written)))
        return Sizes(*written.tolist()) if answered else None

    return answer


def trials_of_row_sizes() -> list[tuple[None, tuple[Array, Array, Array]]]:
    """An even and an odd number of rows, of which some are zero."""
    numbers = np.sin(np.arange(1.0, 74.0))
    A, unit, b = numbers[:30].reshape(10, 3), numbers[30:60].reshape(10, 3), numbers[60:70]
    A = A * (numbers[60:70] < 0.9)[:, None]
    return [(None, (A, unit, b)), (None, (A[:7], unit[:7], -np.abs(b[:7])))]


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
