"""How many cases of each layer of the vectors have each feature of the format.

Run ``python -m validation.make.vector_features --out FILE``.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.features import FEW, counted
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.tools.scripts import ROOT, asked, shown

VECTORS = ROOT / "validation" / "vectors"
HEAD = f"""# Features of the vectors' cases

Made by `python -m validation.make.vector_features`: how many cases of each layer have each feature.
A number below {FEW} is thin; features that no case of a layer has are not its own.
"""


def page() -> Iterator[str]:
    """The committed page."""
    yield HEAD
    counts = {}
    for name in LAYERS:
        expected = expected_read(VECTORS, name)
        cases = ((one.input, expected[one.id]["output"]) for one in inputs_read(VECTORS, name))
        counts[name] = counted(cases)
    rows = [
        (feature, *(str(counts[name][feature] or "") for name in LAYERS))
        for feature in sorted({feature for found in counts.values() for feature in found})
    ]
    yield from markdown_table(("feature", *LAYERS), rows)


def main() -> int:
    """Count, and write the page."""
    options = asked(__doc__, out=Path)
    shown("\n".join(page()), options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
