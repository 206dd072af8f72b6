"""A Python function that is challenged as a program is."""

from collections.abc import Callable

from quasistatic_ref.formats.files import plain
from quasistatic_ref.lab.vectors.challenge.program import Reply
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS

Simulator = Callable[[str, Json], Json]
"""(layer, input) -> output, or None for a layer that it does not answer; arrays are lists."""


class Function:
    """A function with the face of a program; what it raises is an error that it answers.

    Parameters
    ----------
    simulator : callable
    """

    said = Answers()
    layers: tuple[str, ...] = LAYERS
    flood = 0
    starts = 1

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator

    def ask(self, id: str, layer: str, case: Json) -> Reply:
        """What it returns for a case."""
        try:
            output = self._simulator(layer, case)
        except Exception as error:
            return Reply("error", said=f"{type(error).__name__}: {error}"[:200])
        if output is None:
            return Reply("unsupported")
        return Reply("output", output=plain(output))
