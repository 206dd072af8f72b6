"""What a solver's exit code claims, as far as the interface hands the code on."""

import tomllib
from functools import cache
from pathlib import Path

OPTIMAL = "optimal"
INFEASIBLE = "infeasible"
HIDDEN = "hidden"
NEITHER = "neither"
Codes = dict[str, list[str]]
"""Claim -> the words in which an interface hands on the codes that make it."""


@cache
def _table() -> dict[str, dict[str, Codes]]:
    text = (Path(__file__).parent / "exit_codes.toml").read_text("utf-8")
    return tomllib.loads(text)


def exit_codes(interface: str, solver: str) -> Codes:
    """What the table of exit codes has for a solver at an interface.

    Parameters
    ----------
    interface, solver : str
        A solver that is in no line of a listed interface, such as a callable, has the words of
        ``own``.
    """
    table = _table()
    lines = table.get(interface, table["own"])
    return lines.get(solver) or lines.get("every") or table["own"]["every"]


def claim(interface: str, solver: str, status: str) -> str:
    """What a status claims: OPTIMAL, INFEASIBLE, NEITHER, or HIDDEN where it cannot be known.

    Parameters
    ----------
    interface, solver, status : str

    Examples
    --------
    >>> from quasistatic_ref.lab.study.calling.claims import claim
    >>> claim("native", "daqp", "infeasible"), claim("qpsolvers", "daqp", "not found")
    ('infeasible', 'hidden')
    """
    codes = exit_codes(interface, solver)
    return next((said for said, words in codes.items() if status in words), NEITHER)


def hides(interface: str, solver: str) -> bool:
    """Whether an interface keeps back some of what a solver says."""
    return HIDDEN in exit_codes(interface, solver)
