"""The programs of a step's groups in natural units: source/step.c."""

from collections.abc import Callable
from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.addresses import addresses
from quasistatic_ref.optional.compiled.library import function
from quasistatic_ref.solve.by_group import GroupIndex, GroupPrograms, NaturalHessian, layout_of
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import Units

Programs = tuple[GroupPrograms, bool]
Write = Callable[..., Programs | None]


def write(layout: GroupIndex) -> Write:
    """``GroupIndex.write`` in C; it declines rows of a user's own, and numbers not finite."""
    n_v = len(layout.coordinates)
    sizes = np.array([*layout.place.shape, n_v, layout.size])
    kept = addresses((sizes, layout.place, layout.coordinates, layout.rows))
    compiled = function("natural_programs")

    def answer(
        A: Array,
        b: Array,
        g: Array,
        A_extra: Array,
        units: Units,
        H: NaturalHessian,
        programs: GroupPrograms,
    ) -> Programs | None:
        if len(A_extra):
            return None
        read = addresses((A, b, g, H.own_unit, units.coordinate))
        written = addresses((), (programs.g, programs.A, programs.b))
        finite = compiled(*kept, *read, units.length, units.size, *written)
        return (programs, True) if finite else None

    return answer


def trials_of_write() -> list[tuple[GroupIndex, tuple[Any, ...]]]:
    """Programs of two groups, of which each has a contact, of four rows and of six."""
    numbers = np.sin(np.arange(1.0, 61.0))
    J = np.zeros((2, 4, 6))
    J[0, :, :4], J[1, :, 4:] = numbers[:16].reshape(4, 4), numbers[16:24].reshape(4, 2)
    n, d1, d2 = np.repeat(np.eye(3)[[2, 0, 1], None], 2, axis=1)
    contacts = Contacts(("a", "b"), [0.0, 0.01], n, d1, d2, J, [0.5, 0.2], [0.01, 0.02], [4, 6])
    M_u = np.diag(np.arange(1.0, 7.0))
    step = StepData(0.01, [], M_u, [], numbers[:6], [], contacts)
    layout = layout_of(step)
    H = layout.natural_hessian_of(step)
    A = np.where(layout.place < layout.size, numbers.reshape(layout.place.shape), 0.0)
    g, b = numbers[:6], numbers[:10]
    units = Units(H.unit, 0.5, 0.25)
    return [(layout, (A, b, g, np.zeros((0, 6)), units, H, layout.empty_programs(H)))]
