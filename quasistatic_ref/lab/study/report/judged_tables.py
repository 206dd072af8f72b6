"""Tables of claims about feasibility, of clocks that were not confirmed, of the parts of calls."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Table
from quasistatic_ref.lab.study.report.columns import Columns, Where, chosen, groups, size
from quasistatic_ref.lab.study.report.numbers import filter_words, milliseconds, percent
from quasistatic_ref.lab.study.report.solver_tables import solver_cells, solver_headings


def claims_sentence(columns: Columns) -> list[Block]:
    """How many claims were made, and are false."""
    optimal, infeasible, wrong = (columns[n] for n in ("said_optimal", "said_infeasible", "wrong"))
    return [
        f"{int((wrong & optimal).sum()):,} of {int(optimal.sum()):,} claims of success are false, "
        f"and {int((wrong & infeasible).sum()):,} of {int(infeasible.sum()):,} claims that there "
        f"is no solution are false; {int(columns['wrong_multipliers'].sum()):,} claims of success "
        "have wrong multipliers."
    ]


def detection(columns: Columns) -> list[Block]:
    """What solvers say of problems that have no solution: right, wrong, silent."""
    rows = []
    for (label, setting), part in groups(
        chosen(columns, {"feasible": False}), ["label", "setting"]
    ):
        right = int(part["said_infeasible"].sum())
        wrong = int(part["said_optimal"].sum())
        rows.append((label, setting, str(size(part)), str(right), str(wrong),
                     str(size(part) - right - wrong)))  # fmt: skip
    if not rows:
        return ["The study contains no problem without a solution."]
    names = ("solver", "setting", "calls", "right", "wrong", "silent")
    title = (
        "Problems without a solution, as Farkas vectors prove: a call is right if it says "
        "infeasible, wrong if it says optimal, and silent if it says neither."
    )
    return [Table(title, "feasible = false", names, tuple(rows), left=2)]


def failing_clocks(columns: Columns) -> list[Block]:
    """Memory of every solver, and how many of its times the keeper's clock did not confirm."""
    rows = []
    for (label,), part in groups(columns, ["label"]):
        known = part["memory"][np.isfinite(part["memory"])]
        warm = part["warm_up"][np.isfinite(part["warm_up"])]
        if len(known):
            unconfirmed = int((~part["clock_agrees"]).sum())
            slowest = f"{warm.max():.3g}" if len(warm) else "-"
            rows.append((label, f"{known.max() / 1e6:.0f}", str(unconfirmed), slowest,
                         f"{warm.sum():.3g}"))  # fmt: skip
    if not rows:
        return []
    names = ("solver", "memory, peak [MB]", "clock not confirmed", "slowest warm-up [s]",
             "warm-ups [s]")  # fmt: skip
    return [Table("Memory, clocks, warm-ups.", "repetition = 0", names, tuple(rows))]


def parts_of_calls(parts: Sequence[tuple[Columns, str]], where: Where) -> list[Block]:
    """Set-up and solving by the solver's own account, and what is left of a call: conversion.

    Parameters
    ----------
    parts : sequence of (mapping of str to ndarray, str)
        The calls of each solver and interface, and their setting.
    where : mapping
        What they have in common.
    """
    rows = []
    for part, setting in parts:
        own = {name: column[part["solved"]] for name, column in part.items()}
        known = np.isfinite(own["own_solver"])
        if not known.any():
            continue
        call, setup, solving = (own[n][known] for n in ("seconds", "own_setup", "own_solver"))
        left = call - solving - np.where(np.isfinite(setup), setup, 0.0)
        both = np.isfinite(setup).all()
        cells = [milliseconds(float(np.median(call))),
                 milliseconds(float(np.median(setup))) if both else "-",
                 milliseconds(float(np.median(solving))),
                 milliseconds(max(float(np.median(left)), 0.0)),
                 percent(100 * max(float(np.median(left / call)), 0.0))]  # fmt: skip
        rows.append((*solver_cells(part), setting, str(int(known.sum())), *cells))
    if not rows:
        return []
    names = (*solver_headings(parts[0][0]), "setting")
    columns = (*names, "calls solved, times reported", "whole call, median [ms]",
               "set-up, median [ms]", "solving, median [ms]", "conversion, median [ms]",
               "conversion, median of shares [%]")  # fmt: skip
    words = (
        "Set-up and solving are by the solver's own account (natively the set-up is timed here); "
        "conversion is what is left of a call: matrices into the solver's form, and answers back. "
        "Where a solver does not report its set-up separately, the set-up is part of the solving "
        "if the solver counts it there, and otherwise of the conversion."
    )
    title = "Set-up, solving and conversion, each at the setting that delivers 6 digits soonest."
    more = "; outcome = solved, seconds.solver is reported"
    return [words, Table(title, filter_words(where, more), columns, tuple(rows), left=len(names))]
