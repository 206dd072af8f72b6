"""What moves, and what may touch."""

from typing import NamedTuple, Protocol

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import System


class Scene(NamedTuple):
    """What moves, and what may touch.

    Parameters
    ----------
    system : System
    pairs : tuple of ContactPair
    """

    system: System
    pairs: tuple[ContactPair, ...]


class HasScene(Protocol):
    """A Scenario, a Simulator or a Scene."""

    @property
    def system(self) -> System:
        """What moves."""

    @property
    def pairs(self) -> tuple[ContactPair, ...]:
        """What may touch."""
