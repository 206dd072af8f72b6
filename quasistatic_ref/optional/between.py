"""What optional parts ask of each other: slots of core types."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from quasistatic_ref.parts import Slot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from scipy.sparse import csc_matrix

    from quasistatic_ref.contact.distance import ClosestPoints
    from quasistatic_ref.contact.pairs import ContactLayout
    from quasistatic_ref.contact.shape_in_world import ShapeInWorld
    from quasistatic_ref.model.column_map import ColumnMap
    from quasistatic_ref.simulate.recorder import Recorder
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.solve.units import DenseStepInBothUnits, StepInBothUnits
    from quasistatic_ref.step.data import Array, Contacts, Indices, Mask, StepData
    from quasistatic_ref.step.extension import Extension, Rises
    from quasistatic_ref.step.standard_form import StandardForm

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


class BlockColumns(Protocol):
    """Which columns of J the contacts of many bodies keep."""

    def columns(self) -> tuple[Indices, Indices, Array, Array, int]:
        """The fields of :class:`~quasistatic_ref.optional.fast.compiled.scene.Columns`.

        Joint columns and places, of shape (n_c, n_x), and 1.0 where they move alpha and beta.
        """

    def contacts(
        self,
        layout: ContactLayout,
        name: tuple[str, ...],
        points: ClosestPoints,
        d1: Array,
        d2: Array,
        J: Array,
    ) -> Contacts:
        """The contacts at those points, from d1, d2 (n_c, 3) [-], and J (n_c, 4, w) [m, rad]."""


class FloatBound(Protocol):
    """Bounds of errors for steps of one H in natural units."""

    H: Array

    def step_error(self, both: DenseStepInBothUnits, delta_q: Array, lam: Array) -> float:
        """The bound [-] for an answer in SI units."""


class LargeSteps(Protocol):
    """Large steps of one kind."""

    @property
    def entry(self) -> Indices:
        """Where the entries of a sparse A are in the columns of their blocks, (m, w)."""

    def matrices(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """H in natural units, its upper triangle, and a matrix with the pattern of A."""

    def fits(self, step: StepData) -> bool:
        """Whether a step has its entries where these have them, and the same H."""

    def in_both_units(self, step: StepData) -> StepInBothUnits:
        """A step in SI units and in natural units."""

    def from_blocks(self, step: StepData, form: StandardForm) -> StepInBothUnits:
        """The same from the matrices of a step, of which A has the columns of its blocks."""

    def error_bound(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """A rigorous bound of the relative error [-] of delta_q (n_v,), lam (m,) in SI units."""


BLOCK_COLUMNS: Slot[Callable[[ContactLayout, ColumnMap], BlockColumns]] = Slot(
    "large.block_columns"
)
FLOAT_BOUND: Slot[Callable[[Array], FloatBound]] = Slot("large.float_bound")
LARGE_STEPS: Slot[Callable[[StepData], LargeSteps]] = Slot("large.sparse")
