"""The layers of the model, each one module with `expected` and `own`, loaded when it is used.

`expected` is the oracle, with the tolerance of each field, and `own` one of the programs that are
held against it. The oracle is

- in ``selection``, ``jacobian``, ``rows``, ``wrench`` and ``integrate``, and for poses, tangents,
  H, g and forces of a ``step``: the plain program (``lab/program``) over exact numbers. Against it,
  the plain program in float64 tests rounding alone. Its formulas are tested by `own` and by the
  ports of ``validation/ports``, which share no line with it;
- for distances: ``vectors/distances``, which shares with the plain program rotations, the corners
  of shapes and the rules by which contacts are kept, and no distance;
- for optima: the core's exact method. The plain program checks the conditions of each optimum;
- for derivatives: the files, which were made once.
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


COMPUTED = LAYERS[:-1]
"""Those whose answers are computed; the answers of `derivative` are files."""


class Layer(Protocol):
    """What each module of this package offers; that of `derivative` has no `expected`."""

    def expected(self, case_input: Json, /) -> Expected:
        """The answer, exact or in high precision and rounded correctly."""

    def own(self, case_input: Json, /) -> Json:
        """The package's own float64 answer, of the same shape as the output."""


def layer(name: str) -> Layer:
    """Return the module of a layer, one of LAYERS."""
    return cast(Layer, import_module(f"{__name__}.{name}"))
