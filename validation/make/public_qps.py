"""How right solvers are on quadratic programs of others, from a folder of such files.

    python -m validation.make.public_qps FOLDER --study STUDY

FOLDER holds programs as ``quasistatic-ref qp`` reads them, STUDY the rows of calls, which are not
made again if they are there. Writes validation/results/public_qps.md.
"""

import argparse
import statistics
from pathlib import Path

from quasistatic_ref.cli.main import main as command
from quasistatic_ref.lab.study.store import rows_read
from validation.make.public_files import RESULTS

SETTINGS = {"default": "default", "high": "1e-9"}


def label(row):
    """A solver and what it was asked for."""
    return f"{row.solver} {row.version}", SETTINGS[row.setting]


def worst(rows, name):
    """The largest residual of some rows."""
    return max((getattr(row, name) for row in rows if getattr(row, name) is not None), default=None)


def table(head, lines):
    """A table in Markdown."""
    rows = [head, ["---"] * len(head), *lines]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in rows)


def of_solvers(rows):
    """A line a solver and accuracy: what it said, digits and residuals."""
    for key in sorted({label(row) for row in rows}):
        mine = [row for row in rows if label(row) == key]
        able = [row for row in mine if row.feasible]
        empty = [row for row in mine if not row.feasible]
        said = [row for row in able if row.says == "solved" and row.digits is not None]
        digits = [row.digits for row in said]
        least = min(said, key=lambda row: row.digits, default=None)
        residuals = [worst(said, name) for name in ("primal", "dual", "gap")]
        yield [
            *key,
            f"{sum(row.says == 'solved' for row in able)} of {len(able)}",
            sum(row.says == "infeasible" for row in able),
            f"{sum(row.says == 'infeasible' for row in empty)} of {len(empty)}",
            f"{statistics.median(digits):.1f}" if digits else "-",
            f"{least.digits:.1f}" if least else "-",
            least.problem if least else "-",
            *("-" if v is None else f"{v:.0e}" for v in residuals),
        ]


def of_problems(rows, setting):
    """A line a program, with the digits of each solver; a dash where it did not say solved."""
    rows = [row for row in rows if row.setting == setting and row.feasible]
    solvers = sorted({row.solver for row in rows})
    yield ["program", "n", "rows", *solvers]
    for problem in sorted({row.problem for row in rows}):
        mine = {row.solver: row for row in rows if row.problem == problem}
        one = next(iter(mine.values()))
        digits = [
            mine[s].digits if s in mine and mine[s].says == "solved" else None for s in solvers
        ]
        yield [problem, one.n, one.m, *("-" if d is None else f"{d:.1f}" for d in digits)]


def page(rows):
    """The results page."""
    lines = list(of_solvers(rows))
    head = ["solver", "accuracy", "says solved", "says infeasible", "proved infeasible: says so",
            "digits: median", "least", "of", "primal", "dual", "gap"]  # fmt: skip
    parts = [table(head, lines)]
    for setting, words in SETTINGS.items():
        first, *others = of_problems(rows, setting)
        parts.append(f"Digits at accuracy {words}:\n\n{table(first, others)}")
    return "\n\n".join(parts) + "\n"


def main():
    """Make the calls that are missing, and write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--study", type=Path, default=Path("study"))
    options = parser.parse_args()
    command(["qp", str(options.folder), "--out", str(options.study), "--quiet"])
    (RESULTS / "public_qps.md").write_text(page(rows_read(options.study)), "utf-8")


if __name__ == "__main__":
    main()
