"""The layers of the model, each one module with `own`, the package's answer, loaded when used.

What is expected of the committed cases are files. They were made once: with 30 digits, in exact
numbers and balls. The package, the plain program (``lab/program``) and the ports are held to them.
A new case takes the package's answer where the plain program agrees (``agreed``).
"""

from importlib import import_module
from typing import Protocol, cast

from quasistatic_ref.lab.vectors.trees import Json

LAYERS = (
    "distance",
    "selection",
    "jacobian",
    "rows",
    "qp",
    "wrench",
    "integrate",
    "step",
    "derivative",
)
"""In the order in which a step goes through them; `step` is all of them at once."""


class Layer(Protocol):
    """The functions that each module of this package offers: a layer of the vectors."""

    def own(self, case_input: Json, /) -> Json:
        """The package's own float64 answer, of the same shape as the output."""


def layer(name: str) -> Layer:
    """Return the module of a layer, one of LAYERS."""
    return cast(Layer, import_module(f"{__name__}.{name}"))
