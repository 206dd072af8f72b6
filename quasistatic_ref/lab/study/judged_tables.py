"""Tables of claims about feasibility, and of clocks that were not believed."""

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Table
from quasistatic_ref.lab.study.columns import Columns, chosen, groups, size


def claims_sentence(columns: Columns) -> list[Block]:
    """How many claims were made, and are false."""
    optimal, infeasible, wrong = (columns[n] for n in ("said_optimal", "said_infeasible", "wrong"))
    return [
        f"{int((wrong & optimal).sum()):,} of {int(optimal.sum()):,} claims of success are false; "
        f"{int((wrong & infeasible).sum()):,} of {int(infeasible.sum()):,} claims that there is no "
        f"solution are; of {int(columns['wrong_multipliers'].sum()):,} claims of success the "
        "multipliers are wrong."
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
        return ["No problem without a solution was asked."]
    names = ("solver", "setting", "calls", "right", "wrong", "silent")
    title = (
        "Problems without a solution, proved by Farkas vectors: said infeasible, optimal, nothing."
    )
    return [Table(title, "feasible = false", names, tuple(rows), left=2)]


def failing_clocks(columns: Columns) -> list[Block]:
    """Memory of every solver, and whose clock was not borne out by the keeper's."""
    rows = []
    for (label,), part in groups(columns, ["label"]):
        known = part["memory"][np.isfinite(part["memory"])]
        warm = part["warm_up"][np.isfinite(part["warm_up"])]
        if len(known):
            disbelieved = int((~part["clock_agrees"]).sum())
            slowest = f"{warm.max():.3g}" if len(warm) else "-"
            rows.append((label, f"{known.max() / 1e6:.0f}", str(disbelieved), slowest,
                         f"{warm.sum():.3g}"))  # fmt: skip
    if not rows:
        return []
    names = ("solver", "memory, peak [MB]", "clock not believed", "slowest warm-up [s]",
             "warm-ups [s]")  # fmt: skip
    return [Table("Memory, clocks, warm-ups.", "repetition = 0", names, tuple(rows))]
