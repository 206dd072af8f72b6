"""Figures of docs/reality.md from its results: ``python -m validation.make.reality_figures``."""

import argparse
import json
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.examples.gallery import figure_of
from quasistatic_ref.lab.figures import reality
from quasistatic_ref.optional.show.figures.style import figure_style, figure_written

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "validation" / "results"
SHOWN = (
    "ellipsoid", "facets-16", "facets-8", "pyramid, axes at 0 degrees",
    "pyramid, axes at 22.5 degrees", "pyramid, axes at 45 degrees", "product",
    "half of the torsion", "no torsion", "9 points", "25 points", "100 points",
)  # fmt: skip


def result(name: str) -> Any:
    """A committed result."""
    return json.loads((RESULTS / f"{name}.json").read_text("utf-8"))


def main() -> None:
    """Draw all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("reality_figures"))
    options = parser.parse_args()
    identified, ablations = result("reality_identified"), result("reality_ablations")
    shown = [name for name in SHOWN if name in ablations["variants"]]
    with figure_style():
        figures = {
            "reality_pushes": figure_of("which_cone_is_real"),
            "reality_identified": reality.identified_ratios(identified),
            "reality_loads": reality.lost_shares(identified),
            "reality_errors": reality.errors_by_pair(result("reality")),
            "reality_ablations": reality.ablations(ablations, shown),
            "reality_tripods": reality.tripods(result("reality_tripods")),
        }
    for name, figure in figures.items():
        figure_written(figure, options.out, name)


if __name__ == "__main__":
    main()
