"""What moves, and what may touch."""

from dataclasses import dataclass

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import System


@dataclass(frozen=True, eq=False, repr=False)
class Scene:
    """A system and the pairs of its shapes that may touch; Scenario and Simulator are scenes.

    Parameters
    ----------
    system : System
        What moves.
    pairs : tuple of ContactPair
        What may touch.
    """

    system: System
    pairs: tuple[ContactPair, ...]
