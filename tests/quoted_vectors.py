"""What the guides of the reference vectors quote: how many cases there are, which version it is."""

from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.versions import RELEASE
from tests import quoted_sources as of
from validation.make.challenges import ANSWERS


def passed(*layers):
    """Cases over cases of some layers, all passed."""
    return [count for layer in layers for count in 2 * [of.cases_of(layer)]]


def check():
    whole = sum(map(of.cases_of, LAYERS))
    return [
        *(f"| `{layer}` | {of.cases_of(layer)} |" for layer in LAYERS),
        f"| all {len(LAYERS)} layers: {whole}/{whole} |",
        "| 2 of {} layers: rows {}/{}, wrench {}/{} |".format(
            len(LAYERS), *passed("rows", "wrench")
        ),
        "1 of {} layers: rows {}/{} to 6 digits |".format(len(LAYERS), *passed("rows")),
        "step 0/{} and {} in part |".format(*passed("step")),
        f"this package brings version {RELEASE}.",
        f"`quasi-dynamic-vectors-{RELEASE}.zip`",
    ]


CHALLENGE = [f"the plain program, without any mistake, {ANSWERS:,} cases"]

HELD = {
    "docs/guides/check_your_implementation.md": check,
    "docs/guides/challenge_your_program.md": lambda: CHALLENGE,
}
