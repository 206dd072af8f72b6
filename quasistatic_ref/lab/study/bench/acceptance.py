"""What was promised, with its limit, beside what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

PAPER = 90.0
"""The paper's step takes less than this: Julia 1.9.2 on a Mac M1 Pro, all distances, its own
interior-point method, at an accuracy that it does not give [us]."""

OVER_SOLVER = 16.0
"""What a step may cost in bare calls of DAQP, which take 11 us. A step is a hundred and more calls
of NumPy and pinocchio, of about a microsecond each whatever they compute; with fewer, its lines
would not read as the equations."""

STRETCH = {"step over the bare solver": 8.0, "1e6 points over 992": 3.0}


def promises(tables: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Each promise that the tables speak of: what, measured, limit and whether it holds."""
    roads, found = tables["roads"], []

    def promise(what: str, measured: float | None, limit: float, most: bool) -> None:
        if measured is None:
            return
        holds = measured <= limit if most else measured >= limit
        found.append(
            {
                "what": what,
                "measured": measured,
                "limit": limit,
                "sense": "at most" if most else "at least",
                "holds": bool(holds),
            }
        )

    promise("step over the bare solver", roads["over_solver"], OVER_SOLVER, True)
    promise("through CVXPY over native", roads["cvxpy_over_native"], 8.0, False)
    promise("rebuilt each step over native", roads["rebuilt_over_native"], 25.0, False)
    promise("hand-written loop over native", roads["by_hand_over_native"], 1.0, False)
    million = [row for row in tables.get("clouds", []) if row["points"] == 1_000_000]
    for row in million:
        promise("1e6 points over 992", row["over_992"], 6.0, True)
        promise("tree of 1e6 points [s]", row["tree_seconds"], 5.0, True)
    exponents = tables.get("exponents", {})
    promise("exponent in bodies, chains", exponents.get("bodies"), 1.15, True)
    promise("exponent in contacts, chains", exponents.get("contacts"), 1.15, True)
    return found


def from_paper(tables: Mapping[str, Any]) -> float:
    """How many times the paper's 90 us the step takes on this machine [-]."""
    return float(tables["roads"]["microseconds"]["step, native"]) / PAPER
