"""What a solver's exit code says, as far as the door hands the code on."""

import tomllib
from functools import cache
from pathlib import Path

FILE = "exit_codes.toml"
SOLVED, INFEASIBLE, OTHER = SAYINGS = ("solved", "infeasible", "other")


@cache
def _table() -> dict[str, dict[str, dict[str, list[str]]]]:
    text = (Path(__file__).parent / FILE).read_text("utf-8")
    return tomllib.loads(text)


def saying(door: str, solver: str, status: str) -> str:
    """What a solver's word says: ``"solved"``, ``"infeasible"`` or ``"other"``.

    Parameters
    ----------
    door, solver, status : str

    Examples
    --------
    >>> from quasistatic_ref.lab.study.saying import saying
    >>> saying("cvxpy", "daqp", "infeasible"), saying("qpsolvers", "daqp", "not found")
    ('infeasible', 'other')
    """
    of_door = _table()[door]
    codes = of_door.get(solver, of_door.get("every"))
    assert codes, f"{FILE} does not say what {solver} says: add {solver} = ... to its [{door}]"
    return next((says for says, words in codes.items() if status in words), OTHER)
