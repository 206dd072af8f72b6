"""The package's derivatives challenged: ``python -m validation.make.derivatives [--out FILE]``.

`quasistatic-ref vectors challenge` makes new cases of the layer ``derivative``, whose answers are
differences of steps without rounding, or that there are none. Exit status 1 if ``derivatives`` has
a wrong number, or one at a kink; where the package refuses a step, or says that there are none, it
claims no number.
"""

import sys
from pathlib import Path

from quasistatic_ref.lab.vectors.challenge.outcome import Outcome
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.layers import layer
from validation.tools.scripts import script_options, show_page

LAYERS = ("derivative",)
NO_CLAIM = ("LimitExceeded", "StepIllPosed", "the answer says it has none")
"""In the words of a finding: a step is refused, or there is a verdict in the place of numbers."""
PAGE = """# The package's derivatives challenged

Made by `python -m validation.make.derivatives`: {count:,} cases that `vectors challenge` makes of
the layer `derivative`, seed 1. Each answer is compared with differences of steps without rounding,
within four times the tolerance of the reference vectors: 4e-9 of the largest entry of its field,
or of a thousandth of what the field would be without contacts. At a kink there may be none.

{verdicts}.

"""


def challenge_outcome(count: int) -> Outcome:
    """What came of so many cases."""
    (name,) = LAYERS
    own = layer(name).own
    return challenge(lambda _, case: own(case), layers=LAYERS, cases=count, seed=1)


def page(verdicts: dict[str, int], titles: list[str]) -> str:
    """The committed page: how many cases came to what, and what was found."""
    said = ", ".join(f"{count:,} {verdict}" for verdict, count in verdicts.items())
    text = PAGE.format(count=sum(verdicts.values()), verdicts=said.capitalize())
    return text + "".join(f"- {title}\n" for title in titles)


def main() -> int:
    """Challenge, and write the page."""
    options = script_options(__doc__, count=300, out=Path)
    found = challenge_outcome(options.count)
    verdicts = {verdict: count for (_, verdict), count in sorted(found.verdicts.items())}
    titles = [finding.title for finding in found.findings]
    show_page(page(verdicts, titles), options.out)
    return int(not all(any(words in title for words in NO_CLAIM) for title in titles))


if __name__ == "__main__":
    sys.exit(main())
