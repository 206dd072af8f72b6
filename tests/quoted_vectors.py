"""What the guides of the reference vectors quote: how many cases there are, which version it is."""

from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.versions import RELEASE
from tests import quoted_sources as of
from validation.make.challenges import ANSWERS


def passed(*layers):
    """Cases over cases of some layers, all passed."""
    return [count for layer in layers for count in 2 * [of.cases_of(layer)]]


CHECK = [
    *(("| `{}` | {} |", lambda layer=layer: [layer, of.cases_of(layer)]) for layer in LAYERS),
    ("| all {} layers: {}/{} |", lambda: [len(LAYERS), *2 * [sum(map(of.cases_of, LAYERS))]]),
    ("| 2 of {} layers: rows {}/{}, wrench {}/{} |",
     lambda: [len(LAYERS), *passed("rows", "wrench")]),
    ("1 of {} layers: rows {}/{} to 6 digits |", lambda: [len(LAYERS), *passed("rows")]),
    ("step 0/{} and {} in part |", lambda: passed("step")),
    ("this package brings version {}.", lambda: [RELEASE]),
    ("`quasi-dynamic-vectors-{}.zip`", lambda: [RELEASE]),
]  # fmt: skip
CHALLENGE = [("the plain program, without any mistake, {:,} cases", lambda: [ANSWERS])]

HELD = {
    "docs/guides/check_your_implementation.md": lambda: CHECK,
    "docs/guides/challenge_your_program.md": lambda: CHALLENGE,
}
