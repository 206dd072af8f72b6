"""Stores of version 1, read as those of today: what they did not measure is null."""

from typing import Any


def today_row(row: dict[str, Any]) -> dict[str, Any]:
    """A row of a store of any version, with today's fields.

    Parameters
    ----------
    row : dict
        As parsed from JSON; of a sweep, or of no study at all, it comes back as it is.
    """
    if "road" not in row or "interface" in row:
        return row
    return {"interface" if name == "road" else name: value for name, value in row.items()}


def today_study(study: dict[str, Any]) -> dict[str, Any]:
    """What ``study.json`` of a store of any version holds, with today's names."""
    solvers = study.get("solvers")
    if study.get("version") != 1 or not isinstance(solvers, list):
        return study
    named = [today_row(solver) if isinstance(solver, dict) else solver for solver in solvers]
    return study | {"solvers": named}
