"""How many cases of each layer of the vectors have each feature of the format.

Run ``python -m validation.make.vector_features --out FILE``.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

from quasistatic_ref.lab.vectors.features import feature_counts
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.tools.scripts import ROOT, script_options, show_page

VECTORS = ROOT / "validation" / "vectors"


def page() -> Iterator[str]:
    """The committed table, in CSV: a feature a line, the layers in columns."""
    counts = {}
    for name in LAYERS:
        expected = expected_read(VECTORS, name)
        cases = ((one.input, expected[one.id]["output"]) for one in inputs_read(VECTORS, name))
        counts[name] = feature_counts(cases)
    yield ",".join(("feature", *LAYERS))
    for feature in sorted({feature for found in counts.values() for feature in found}):
        yield ",".join((feature, *(str(counts[name][feature]) for name in LAYERS)))


def main() -> int:
    """Count, and write the table."""
    options = script_options(__doc__, out=Path)
    show_page("\n".join(page()), options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
