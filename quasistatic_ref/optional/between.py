"""What optional parts ask of each other: slots of core types."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from quasistatic_ref.parts import Slot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from quasistatic_ref.contact.shape_in_world import ShapeInWorld
    from quasistatic_ref.simulate.recorder import Recorder
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.solve.units import DenseStepInBothUnits
    from quasistatic_ref.step.data import Array, Contacts, Indices, Mask, StepData
    from quasistatic_ref.step.extension import Extension, Rises

POSED: Slot[Callable[[StepData, Extension], tuple[StepData, bool]]] = Slot("extensions.extended")
"""A step with what of an extension is data, and whether that is all of it."""
WITH_RISES: Slot[Callable[[StepData, Rises], StepData]] = Slot("extensions.rises")
STRAY: Slot[Callable[[Array], Mask]] = Slot("scans.cloud")
"""Which points (N, 3) [m] no gap of a few spacings joins to the others."""
OTHER_WAYS_OUT: Slot[Callable[[ShapeInWorld, ShapeInWorld, float], list[Array]]] = Slot(
    "curved.by_coal"
)
"""Normals of two curved solids whose gap the search found to be as wide, but for so much [m]."""


class Said(NamedTuple):
    """What a finding says: its sentence is ``remedy: cause``.

    Parameters
    ----------
    remedy, cause : str
    numbers : dict of str to float
        By names that end in their unit [any unit].
    """

    remedy: str
    cause: str
    numbers: dict[str, float]


class FinishedRun(Protocol):
    """A run as the doctor has it."""

    simulator: Simulator
    recorder: Recorder
    g: float

    @property
    def bounded(self) -> Indices:
        """Coordinates with limits."""

    def forces(self, k: int) -> Array:
        """Forces of single contacts in step k, shape (n_c, 4) [N, N m]."""

    def contacts(self, k: int) -> Contacts:
        """The contacts of step k."""


class TaskOfRun(Protocol):
    """What a run was made for."""

    def found(self, name: str) -> Iterator[Said]:
        """What the finding of a name has to say."""


TASK: Slot[Callable[[FinishedRun, Trajectory], TaskOfRun]] = Slot("account.task")
OF_TASK: Slot[Sequence[tuple[str, bool]]] = Slot("account.task")
"""Names of findings of the task, and whether each is grave."""


class FloatBound(Protocol):
    """Bounds of errors for steps of one H in natural units."""

    H: Array

    def step_error(self, both: DenseStepInBothUnits, delta_q: Array, lam: Array) -> float:
        """The bound [-] for an answer in SI units."""


FLOAT_BOUND: Slot[Callable[[Array], FloatBound]] = Slot("large.float_bound")
