"""Proofs that are kept: what rests is the same program in each step, and has the same answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quasistatic_ref.numbers.arrays import read_only
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.certify.exact import ExactOptimum


class Proofs:
    """The proofs of the groups of the last step: of equal data and start the same, bit for bit.

    What it gives depends on nothing else, and so on no step before.
    """

    def __init__(self) -> None:
        # Of each group: what it was as a step, the rows that its search started from, the end.
        self._last: dict[int, tuple[StepData, list[int], ExactOptimum]] = {}

    def kept(self, i: int, part: StepData, start: Sequence[int]) -> ExactOptimum | None:
        """The optimum of the group number i, if that is what it was in the last step."""
        if i not in self._last:
            return None
        last, begun, optimum = self._last[i]
        return optimum if begun == [*start] and part.same_as(last) else None

    def keep(self, i: int, part: StepData, start: Sequence[int], optimum: ExactOptimum) -> None:
        """Keep the proof of the group number i in place of that of the last step."""
        for array in (optimum.delta_q, optimum.lam, optimum.net):
            read_only(array)
        self._last[i] = part, [*start], optimum
