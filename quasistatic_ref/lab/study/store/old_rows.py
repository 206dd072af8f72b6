"""Stores of earlier versions, read as those of today.

Those of version 1 have null for what they did not measure. They call the field ``interface`` by its
former name, ``road``; their times are of one call each, cold, in one fixed order; and a false claim
that there is no solution, which their own status still shows, counted as a failure.
"""

from typing import Any

from quasistatic_ref.lab.study.calling.infeasibility import says_infeasible
from quasistatic_ref.lab.study.measuring.environment import UNKNOWN
from quasistatic_ref.lab.study.measuring.grade import CLOCKS


def today_row(row: dict[str, Any]) -> dict[str, Any]:
    """A row of a store of any version, with today's fields.

    Parameters
    ----------
    row : dict
        As parsed from JSON; of a sweep, or of no study at all, it comes back as it is.
    """
    if "road" not in row or "interface" in row:
        return row
    named = _renamed(row)
    seconds: Any = named.get("seconds")
    digits: Any = named.get("digits")
    claimed: Any = named.get("claimed")
    tables = isinstance(seconds, dict) and isinstance(digits, dict) and isinstance(claimed, str)
    if not tables or "said_optimal" not in named or "wrong" not in named:
        return named  # whose shape is refused by its field
    said = not named["said_optimal"] and says_infeasible(claimed)
    return named | {
        "feasible": True, "said_infeasible": said, "wrong": named["wrong"] or said,
        "wrong_multipliers": False, "digits": digits | {"multipliers": None}, "calls": 1,
        "seconds": dict.fromkeys(CLOCKS) | seconds | {"solver": None}, "clock_agrees": None,
        "memory": None,
    }  # fmt: skip


def today_study(study: dict[str, Any]) -> dict[str, Any]:
    """What ``study.json`` of a store of any version holds, with today's names."""
    machine = study.get("machine")
    if isinstance(machine, dict):
        study = study | {"machine": {k: _known(v) for k, v in machine.items()}}
    solvers = study.get("solvers")
    if study.get("version") != 1 or not isinstance(solvers, list):
        return study
    named = [_renamed(solver) if isinstance(solver, dict) else solver for solver in solvers]
    return study | {"solvers": named}


def _known(value: Any) -> Any:
    """A fact of a machine, with today's word for one that the system did not report."""
    return UNKNOWN if value == "not told" else value


def _renamed(table: dict[str, Any]) -> dict[str, Any]:
    """A row or a solver with today's name of the interface."""
    return {"interface" if name == "road" else name: value for name, value in table.items()}
