"""The package's derivatives challenged: ``python -m validation.make.derivatives [--out FILE]``.

`quasistatic-ref vectors challenge` makes new cases of the layer ``derivative``, whose answers are
differences of steps without rounding, or the reasons why there are none. Exit status 1 if
``derivatives`` answers one of them wrong.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.vectors.challenge.live import challenge
from quasistatic_ref.lab.vectors.challenge.outcome import Outcome
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import layer

PAGE = """# The package's derivatives challenged

Made by `python -m validation.make.derivatives`: {count:,} cases that `vectors challenge` makes of
the layer `derivative`, seed 1. Each answer is compared with differences of steps without rounding,
within four times the tolerance of the reference vectors: 4e-9 of the largest entry of its field,
or of a thousandth of what the field would be without contacts.

| the package answers | cases |
|---|---|
| numbers | {numbers:,} |
| reasons why there are none | {reasons:,} |

Verdicts: {verdicts}.
"""


def challenged(count: int) -> tuple[Outcome, Counter[str]]:
    """What came of so many cases, and how many were answered by numbers and by reasons."""
    kinds: Counter[str] = Counter()

    def own(name: str, case: Json) -> Json:
        answer = layer(name).own(case)
        kinds["numbers" if answer["differentiable"] else "reasons"] += 1
        return answer

    return challenge(own, layers=["derivative"], cases=count, seed=1), kinds


def main() -> int:
    """Challenge, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000, help="cases")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the page here")
    options = parser.parse_args()
    found, kinds = challenged(options.count)
    verdicts = {verdict: count for (_, verdict), count in sorted(found.verdicts.items())}
    said = ", ".join(f"{count:,} {verdict}" for verdict, count in verdicts.items())
    text = PAGE.format(
        count=found.sent.total(), numbers=kinds["numbers"], reasons=kinds["reasons"], verdicts=said
    )
    print(text) if options.out is None else text_written(options.out, text)
    print(*(finding.title for finding in found.findings), sep="\n")
    return int(bool(found.findings))


if __name__ == "__main__":
    sys.exit(main())
