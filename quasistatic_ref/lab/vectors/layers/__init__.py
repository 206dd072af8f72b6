"""The layers of the model, each one module with `expected` and `own`, loaded when it is used."""

from importlib import import_module
from typing import Protocol, cast

from quasistatic_ref.lab.vectors.expected import Expected, Json

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
    """What each module of this package offers."""

    def expected(self, case_input: Json, /) -> Expected:
        """The answer, exact or in high precision and rounded correctly."""

    def own(self, case_input: Json, /) -> Json:
        """The package's own float64 answer, of the same shape as the output."""


def layer(name: str) -> Layer:
    """Return the module of a layer, one of LAYERS."""
    return cast(Layer, import_module(f"{__name__}.{name}"))
