"""Each family of ``contact-qp-1`` at both ends of its dial.

Run ``python -m validation.make.contact_qp``.

Four solvers are called at 1e-9 in natural units, once each and without a clock: what is compared
are correct digits and iterations. Writes their summary, a table and a figure.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterable, Sequence
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import spsolve

from quasistatic_ref.certify.digits import digits_of_error
from quasistatic_ref.lab.figures.line_styles import pens
from quasistatic_ref.lab.folders import problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.study.calling.calls import tried
from quasistatic_ref.lab.study.calling.native import Native
from quasistatic_ref.lab.study.calling.options import options_at
from quasistatic_ref.lab.study.problems.folder import manifest, set_read
from quasistatic_ref.lab.study.problems.problem import SOCP, SPARSE, Problem
from quasistatic_ref.optional.fast.adapters.clarabel import Clarabel
from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.style import PAGE
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

ROOT = Path(__file__).parents[2]
ROWS = ROOT / "validation" / "results" / "contact_qp.csv"
TABLE = ROOT / "validation" / "results" / "contact_qp.md"
FIGURE = ROOT / "docs" / "figures" / "contact_qp.png"
SOLVERS = ("daqp", "piqp", "clarabel", "osqp")
OF_SPARSE = ("piqp", "clarabel", "osqp")
OF_CONES = ("clarabel",)
ACCURACY = 1e-9
NARROW = 1e3
"""Ratio of a dial's ends below which powers of ten are too few ticks."""
PARTS = 5
"""Of a dial, with equally many problems each."""


def graded_answer(one: Problem, solver: str) -> dict[str, Any]:
    """What a solver says to a problem, and how many digits of it are right."""
    natural = one.natural
    reply = tried(lambda: replied(natural, solver))
    row = {"family": one.facts["family"], "dial": one.facts["dial"], "solver": solver,
           "solved": reply.solved, "iterations": reply.iterations, "digits": 0.0}  # fmt: skip
    if reply.solved and reply.x is not None and not one.answer.farkas:
        row["digits"] = digits(natural, np.asarray(reply.x))
    return row


def replied(natural: Problem, solver: str) -> Reply:
    """Natively; of sparse matrices through qpsolvers."""
    options = options_at(solver, "native", ACCURACY)
    if SPARSE in natural.facts["tags"]:
        H, A = csc_matrix(natural.H), csc_matrix(natural.A)
        return qpsolvers_reply(StandardForm(H, natural.g, A, natural.b), solver, options)
    if natural.facts["kind"] == SOCP:
        H, g, A, b = natural.form
        return Clarabel(Program(H, -g, A, b, cones=len(b) // 4), options).reply(True, False)
    return Native(solver)(natural.form, options)


def digits(natural: Problem, x: np.ndarray) -> float:
    """Correct digits of x, in natural units."""
    if not np.isfinite(x).all():
        return 0.0
    H, off = csc_matrix(natural.H), x - natural.answer.x
    free = float(natural.g @ spsolve(H, natural.g))
    if free == 0:
        return 16.0 if not off.any() else 0.0
    error = float(np.sqrt(max(off @ (H @ off), 0.0) / free))
    return digits_of_error(max(error, natural.answer.error))


def rows_of(members: Iterable[Problem]) -> list[dict[str, Any]]:
    """Every solver on every problem that it has a place for."""
    rows = []
    for one in members:
        of_kind = {SOCP: OF_CONES}.get(one.facts["kind"], SOLVERS)
        rows += [graded_answer(one, name) for name in
                 (OF_SPARSE if SPARSE in one.facts["tags"] else of_kind)]  # fmt: skip
    return rows


def parts(rows: Sequence[dict[str, Any]], backwards: bool) -> list[list[dict[str, Any]]]:
    """Rows from the easy end of the dial to the hard one, in equal parts."""
    order = sorted(rows, key=lambda row: float(row["dial"]), reverse=backwards)
    cuts = np.linspace(0, len(order), PARTS + 1).round().astype(int)
    return [order[a:b] for a, b in pairwise(cuts)]


def summary(rows: Sequence[dict[str, Any]], families: dict[str, Any]) -> list[dict[str, Any]]:
    """A line for each family, solver and part of the dial."""
    found = []
    for family, solver in product([name for name in families if families[name]["dial"]], SOLVERS):
        dial = families[family]["dial"]
        own = [row for row in rows if row["family"] == family and row["solver"] == solver]
        for part, some in enumerate(parts(own, dial["first"] > dial["most"]) if own else ()):
            digits_ = [row["digits"] for row in some]
            known = [row["iterations"] for row in some if row["iterations"] is not None]
            found.append({
                "family": family, "solver": solver, "part": part, "problems": len(some),
                "dial": f"{np.exp(np.mean(np.log([row['dial'] for row in some]))):.3g}",
                "solved": f"{100 * np.mean([row['solved'] for row in some]):.1f}",
                "digits_of_nine_in_ten": f"{np.quantile(digits_, 0.1):.1f}",
                "digits_median": f"{np.median(digits_):.1f}",
                "iterations_median": f"{np.median(known):g}" if known else "",
            })  # fmt: skip
    return found


def table(lines: Sequence[dict[str, Any]], families: dict[str, Any]) -> str:
    """Both ends of every dial, side by side."""
    rows = []
    names = ("digits_of_nine_in_ten", "solved", "iterations_median")
    for easy, hard in zip(lines[::PARTS], lines[PARTS - 1 :: PARTS], strict=True):
        family, own = easy["family"], families[easy["family"]]["dial"]
        dial = f"{own['name']}, {own['first']:g} to {own['most']:g}"
        cells = [end[name] for name in names for end in (easy, hard)]
        if family == "infeasible":
            cells[:2] = "", ""
        rows.append((f"`{family}`", dial, easy["solver"], *cells))
    head = ("family", "dial", "solver", "digits of nine in ten, easy fifth", "hard fifth",
            "solved, easy fifth", "hard fifth", "iterations, easy fifth", "hard fifth")  # fmt: skip
    return "\n".join(markdown_table(head, rows, left=3)) + "\n"


def figure(lines: Sequence[dict[str, Any]], families: dict[str, Any], path: Path) -> None:
    """Digits against the dial, or false solutions of infeasible problems: a picture a family."""
    shown = list(dict.fromkeys(line["family"] for line in lines))
    columns, drawn = 3, pens(SOLVERS)
    down = -(-len(shown) // columns)
    with figure_style("paper"):
        fig, axes = plt.subplots(down, columns, figsize=(PAGE, 1.6 * down), layout="constrained")
        for ax, family in zip(axes.flat, shown, strict=False):
            for solver in SOLVERS:
                own = [one for one in lines if (one["family"], one["solver"]) == (family, solver)]
                name = "solved" if family == "infeasible" else "digits_of_nine_in_ten"
                heights = [float(one[name]) for one in own]
                ax.plot([float(one["dial"]) for one in own], heights, **drawn[solver])
            _axes(ax, family, families[family]["dial"])
        for ax in list(axes.flat)[len(shown) :]:
            ax.axis("off")
        handles, labels = axes.flat[0].get_legend_handles_labels()
        fig.legend(handles, labels, loc="lower right", title="at 1e-9")
        fig.savefig(path, dpi=160)
        plt.close(fig)


def _axes(ax: Axes, family: str, dial: dict[str, Any]) -> None:
    """The dial along the bottom, easy problems left; what is measured along the side."""
    low, high = sorted((dial["first"], dial["most"]))
    ax.set_xscale("log")
    ax.xaxis.set_minor_formatter(NullFormatter())
    if high < NARROW * low:  # no two powers of ten inside
        ticks = [m * 10.0**e for e in range(-6, 7) for m in (1, 2, 5)]
        inside = [v for v in ticks if low <= v <= high]
        ax.set_xticks(inside[:: -(-len(inside) // 4)], minor=False)
        ax.xaxis.set_major_formatter("{x:g}")
        ax.minorticks_off()
    if dial["first"] > dial["most"]:
        ax.invert_xaxis()
    unit = f" [{dial['unit']}]"
    ax.set_title(family)
    ax.set_xlabel(f"{dial['name']}{unit}")
    if family == "infeasible":
        ax.set_ylim(-4, 104)
        ax.set_ylabel("said solved [%]")
    else:
        ax.set_ylim(-0.7, 16.7)
        ax.set_ylabel("digits [-]")


def main() -> int:
    """Measure, or with ``--drawn`` only draw what was measured."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--set", type=Path, default=problem_set_folder())
    parser.add_argument("--drawn", action="store_true", help="of the committed rows")
    options = parser.parse_args()
    families = manifest(options.set)["families"]
    if not options.drawn:
        rows = rows_of(set_read(options.set))
        lines = summary([row for row in rows if row["dial"] is not None], families)
        with ROWS.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(lines[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(lines)
    with ROWS.open(newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    TABLE.write_text(table(lines, families), encoding="utf-8")
    figure(lines, families, FIGURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
