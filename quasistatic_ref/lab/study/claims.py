"""What a solver's exit code claims, as far as the door hands the code on."""

import tomllib
from functools import cache
from pathlib import Path

OPTIMAL = "optimal"
INFEASIBLE = "infeasible"
HIDDEN = "hidden"
NEITHER = "neither"
Codes = dict[str, list[str]]
"""Claim -> the words in which a door hands on the codes that make it."""


@cache
def _table() -> dict[str, dict[str, Codes]]:
    text = (Path(__file__).parent / "exit_codes.toml").read_text("utf-8")
    return tomllib.loads(text)


def exit_codes(door: str, solver: str) -> Codes:
    """What the table of exit codes has for a solver behind a door.

    Parameters
    ----------
    door, solver : str
    """
    lines = _table()[door]
    return lines.get(solver) or lines["every"]


def claim(door: str, solver: str, status: str) -> str:
    """What a status claims: OPTIMAL, INFEASIBLE, NEITHER, or HIDDEN where it cannot be known.

    Parameters
    ----------
    door, solver, status : str

    Examples
    --------
    >>> from quasistatic_ref.lab.study.claims import claim
    >>> claim("cvxpy", "daqp", "infeasible"), claim("qpsolvers", "daqp", "not found")
    ('infeasible', 'hidden')
    """
    codes = exit_codes(door, solver)
    return next((meaning for meaning, words in codes.items() if status in words), NEITHER)
