"""The layers of the model, each one module with `expected` and `own`, loaded when it is used.

`expected` is the oracle, with the tolerance of each field, and `own` one of the programs that are
held against it. The oracle is

- in ``selection``, ``jacobian``, ``rows``, ``wrench`` and ``integrate``: the plain program
  (``lab/program``) over exact numbers. Against it, the plain program in float64 tests rounding
  alone. Its formulas are tested by `own` and by the ports of ``validation/ports``, which share no
  line with it;
- for optima: the core's exact method. The plain program checks the conditions of each optimum;
- for distances, steps and derivatives: the files, which were made once. The package, the plain
  program and the port are held to them.
"""

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


FILES = ("distance", "step", "derivative")
"""Those whose answers are files."""
COMPUTED = tuple(name for name in LAYERS if name not in FILES)
"""Those whose answers are computed."""


class Layer(Protocol):
    """What each module of this package offers; those of FILES have no `expected`."""

    def expected(self, case_input: Json, /) -> Expected:
        """The answer, exact or in high precision and rounded correctly."""

    def own(self, case_input: Json, /) -> Json:
        """The package's own float64 answer, of the same shape as the output."""


def layer(name: str) -> Layer:
    """Return the module of a layer, one of LAYERS."""
    return cast(Layer, import_module(f"{__name__}.{name}"))
