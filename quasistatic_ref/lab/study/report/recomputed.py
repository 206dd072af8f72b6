"""The first table of a report again, by ten lines of pandas that stand in the report."""

from pathlib import Path

from quasistatic_ref.lab.study.report.comparison import WANTED, Comparison
from quasistatic_ref.lab.study.report.statistics import SHIFT


def lines_of_pandas(comparison: Comparison) -> str:
    """The lines, for one study: its units, starts and time limit are put in."""
    text = (Path(__file__).parent / "ten_lines.txt").read_text(encoding="utf-8")
    return text.format(
        warm=comparison.base["warm"],
        units=comparison.base["units"],
        least=WANTED,
        limit=comparison.limit,
        shift=SHIFT,
    )
