"""Proofs that are kept: what rests is the same program in each step, and has the same answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from quasistatic_ref.numbers.arrays import read_only
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.certify.exact import ExactOptimum


class Proof(NamedTuple):
    """What a group was, where its search started, and what that ended with.

    Parameters
    ----------
    part : StepData
        The group as a step.
    start : list of int
        Rows of it.
    optimum : ExactOptimum
    """

    part: StepData
    start: list[int]
    optimum: ExactOptimum


class Proofs:
    """The proofs of the groups of the last step: of equal data and start the same, bit for bit.

    What it gives depends on nothing else, and so on no step before.
    """

    def __init__(self) -> None:
        self._every: dict[int, Proof] = {}

    def kept(self, i: int, part: StepData, start: Sequence[int]) -> ExactOptimum | None:
        """The optimum of the group number i, if that is what it was in the last step."""
        last = self._every.get(i)
        if last is None or last.start != [*start] or not part.same_as(last.part):
            return None
        return last.optimum

    def keep(self, i: int, part: StepData, start: Sequence[int], optimum: ExactOptimum) -> None:
        """Keep the proof of the group number i in place of that of the last step."""
        for array in (optimum.delta_q, optimum.lam, optimum.net):
            read_only(array)
        self._every[i] = Proof(part, [*start], optimum)
