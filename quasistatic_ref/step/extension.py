"""What the core knows of an extension, which it hands on to ``optional/extensions``."""

from collections.abc import Callable
from typing import Protocol

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.step.data import Extra, StepData


class StepRises(Protocol):
    """Un-actuated coordinates that exist within one step alone."""

    @property
    def contacts(self) -> Indices:
        """Numbers of the contacts that some of them lift."""


class StepExtension(Protocol):
    """What a user adds to a step: constraints and costs of his own."""

    @property
    def rows(self) -> Extra | None:
        """Linear inequalities of delta_q as numbers."""

    @property
    def rises(self) -> StepRises:
        """Coordinates that this extension adds to the step."""

    @property
    def same_for_all_loads(self) -> bool:
        """Whether it is numbers alone, which no target or load changes."""

    @property
    def without_stiffness(self) -> bool:
        """Whether its costs take the place of the impedance (1)."""


ExtensionOfQ = Callable[[Array], StepExtension]
"""An extension at each q, shape (n_q,)."""
Posed = Callable[[StepData, StepExtension], tuple[StepData, bool]]
"""A step and what a user adds -> the step with what of it is data, and whether that is all."""
