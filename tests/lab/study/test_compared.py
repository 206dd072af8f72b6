"""What papers compare solvers by, on rows of which each number is known; and what figures name."""

from math import prod

import pytest
from matplotlib import pyplot as plt

from quasistatic_ref.lab.figures.study import (
    digits_time,
    performance_profile,
    reached_digits,
    shifted_means,
)
from quasistatic_ref.lab.study.page import points, ratios, reached
from tests.lab.study.asked import Row, page, page_written, table_of

SECONDS = {"quick": (1.0, 0.2, 0.1), "slow": (0.5, 0.8, 0.2), "false": (0.1, 0.1, 0.1)}
DIGITS = {"quick": (6.0, 9.0, 5.9), "slow": (12.0, 7.0, 8.0), "false": (3.0, 0.0, 15.0)}
SAYS = {"false": "other"}
NAMES = [f"qpsolvers:{name}" for name in SECONDS]


def row(solver, k, setting="default", **facts):
    """The row of a call: a problem by its number, and what is known of it."""
    shared = {"family": "f", "n": 1, "m": 1, "dial": None, "feasible": True, "door": "qpsolvers",
              "version": "1", "accuracy": None, "options": "{}", "units": "natural",
              "status": "", "primal": None, "dual": None, "gap": None, "reached": None,
              "machine": ""}  # fmt: skip
    known = {"digits": DIGITS[solver][k], "seconds": SECONDS[solver][k]}
    known["says"] = SAYS.get(solver, "solved")
    return Row(problem=str(k), solver=solver, setting=setting, **shared | known | facts)


ROWS = [row(solver, k) for solver in SECONDS for k in range(3)]


def cells(text, heading):
    """The table below a heading, a list of cells for each solver."""
    lines = text.partition(f"## {heading}\n")[2].partition("\n## ")[0].splitlines()
    split = [line.strip("| ").split(" | ") for line in lines if line.startswith("| qpsolvers")]
    return {name: others for name, *others in split}


def test_a_profile_counts_problems_solved_within_factors_of_the_fastest():
    """Of each problem the fastest that has six digits: 0.5 s by slow, 0.2 by quick, 0.2 by slow."""
    table = table_of(ROWS)
    by_solver = ratios(table).groupby("label")["ratio"].agg(sorted).to_dict()
    assert by_solver == {
        "qpsolvers:quick": [1.0, 2.0, float("inf")],
        "qpsolvers:slow": [1.0, 1.0, 4.0],
        "qpsolvers:false": [float("inf")] * 3,
    }
    assert cells(page(table), "Performance profile") == {
        "qpsolvers:slow": ["66.7", "66.7", "100.0", "100.0", "100.0", "100.0"],
        "qpsolvers:quick": ["33.3", "66.7", "66.7", "66.7", "66.7", "66.7"],
        "qpsolvers:false": ["0.0"] * 6,
    }


def test_a_shifted_mean_is_that_of_qpbenchmark_where_what_is_not_solved_takes_the_limit():
    """The third root of the product of (t + 10), less 10, in seconds; the limit is 2 s."""
    times = {"quick": (1.0, 0.2, 2.0), "slow": (0.5, 0.8, 0.2), "false": (2.0, 2.0, 2.0)}
    shown = {name: line[7] for name, line in cells(page(table_of(ROWS)), "Who solves what").items()}
    assert shown.keys() == {*NAMES}
    for name, seconds in times.items():
        mean = prod(t + 10 for t in seconds) ** (1 / 3) - 10
        assert float(shown[f"qpsolvers:{name}"]) == pytest.approx(1e3 * mean, rel=5e-3)


def test_rows_of_problems_without_a_solution_have_a_page(tmp_path):
    none = [row("quick", k, feasible=False, digits=None) for k in range(2)]
    (path,) = page_written(none, tmp_path)
    assert "| quick | 2 |" in path.read_text("utf-8")


ACCURATE = [row("slow", k, one, reached=True) for k in range(3) for one in ("mid", "high")]


@pytest.mark.parametrize("rows", [ROWS, ROWS + ACCURATE], ids=["defaults", "three settings"])
def test_legends_name_what_is_drawn_and_axes_no_displacement(rows):
    table = table_of(rows)
    figures = {digits_time: points, shifted_means: points, performance_profile: ratios}
    if rows != ROWS:
        figures[reached_digits] = reached
    for draw, data in figures.items():
        figure = draw(data(table))
        (axes,) = figure.axes
        (legend,) = figure.legends

        def look(line):
            return line.get_label(), line.get_linestyle(), line.get_marker(), line.get_fillstyle()

        drawn = {look(line) for line in axes.lines}
        named = {look(handle) for handle in legend.legend_handles}
        explained = {("setting default", "None", "o", "left")}
        both = draw is digits_time and rows != ROWS
        assert named - drawn == (explained if both else set())
        assert {name for name, *_ in drawn} == {name for name, *_ in named - explained}
        assert "delta" not in axes.get_xlabel() + axes.get_ylabel()
        plt.close(figure)
