"""What optional parts ask of each other: slots of core types."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from quasistatic_ref.parts import Slot

if TYPE_CHECKING:
    from collections.abc import Callable

    from quasistatic_ref.contact.shape_in_world import ShapeInWorld
    from quasistatic_ref.solve.units import DenseStepInBothUnits
    from quasistatic_ref.step.data import Array, Mask, StepData
    from quasistatic_ref.step.extension import Rises

WITH_RISES: Slot[Callable[[StepData, Rises], StepData]] = Slot("extensions.rises")
STRAY: Slot[Callable[[Array], Mask]] = Slot("scans.cloud")
"""Which points (N, 3) [m] no gap of a few spacings joins to the others."""
OTHER_WAYS_OUT: Slot[Callable[[ShapeInWorld, ShapeInWorld, float], list[Array]]] = Slot(
    "curved.by_coal"
)
"""Normals of two curved solids whose gap the search found to be as wide, but for so much [m]."""


class FloatBound(Protocol):
    """Bounds of errors for steps of one H in natural units."""

    H: Array

    def step_error(self, both: DenseStepInBothUnits, delta_q: Array, lam: Array) -> float:
        """The bound [-] for an answer in SI units."""


FLOAT_BOUND: Slot[Callable[[Array], FloatBound]] = Slot("large.float_bound")
