"""A study that goes on in its folder: what may have changed since it was begun, and what not.

Rows that are there are skipped in ``measuring/run.py``.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError

PASSING = ("load",)
"""What is of the moment, and not of the machine."""
SAME = ("kind", "time_limit", "budget", "warm_up", "memory", "repetitions", "problems")
"""What rows are comparable under, besides settings and options."""
BY_SETTING = ("options", "promise")
"""What a solver has at each setting."""
Differs = Callable[[str], InputError]
"""What differs -> the error that says so."""


def continued(there: Mapping[str, Any], wanted: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """What a store of a study that goes on holds: solvers may come, and go.

    Parameters
    ----------
    there : mapping
        What the folder holds.
    wanted : mapping
        What the study file gives today.
    folder : Path

    Returns
    -------
    dict
        `wanted`, with the settings, versions and machine of the rows that are there; solvers that
        are no longer in the study file are not ``present``.

    Raises
    ------
    InputError
        If rows of today could not be compared with those that are there.
    """
    if "machines" in there:
        problem = "holds merged results, which no machine continues; choose another with --out"
        raise InputError(problem, file=folder)

    def differs(name: str) -> InputError:
        words = f"holds a study that was begun with another {name!r}; choose another folder with "
        return InputError(f"{words}--out, or remove this one", file=folder)

    both = joined(there, wanted, differs)
    labels = {solver_label(solver) for solver in wanted.get("solvers", ())}
    for solver in both["solvers"]:
        solver["present"] = solver_label(solver) in labels
    places = {}
    for name in ("machine", "versions"):
        if lasting(there[name], wanted[name]) != lasting(wanted[name], there[name]):
            raise differs(name)
        places[name] = {**wanted[name], **there[name]}
    return {**wanted, **both, **places}


def joined(one: Mapping[str, Any], other: Mapping[str, Any], differs: Differs) -> dict[str, Any]:
    """Settings and solvers of two studies, each solver with the options of every setting."""
    for name in SAME:
        if (one.get(name) or None) != (other.get(name) or None):
            raise differs(name)
    settings = {setting["name"]: setting for setting in one["settings"]}
    for setting in other.get("settings", ()):
        if settings.setdefault(setting["name"], setting) != setting:
            raise differs(f"setting {setting['name']}")
    solvers = {solver_label(solver): dict(solver) for solver in one["solvers"]}
    for solver in other.get("solvers", ()):
        own = solvers.setdefault(solver_label(solver), dict(solver))
        if own["target"] != solver["target"] or any(
            own[part].get(name, value) != value
            for part in BY_SETTING
            for name, value in solver[part].items()
        ):
            raise differs(f"solver or options {solver_label(solver)}")
        for part in BY_SETTING:
            own[part] = {**own[part], **solver[part]}
        own["present"] = own.get("present", True) or solver.get("present", True)
    order = dict.fromkeys([*map(solver_label, other.get("solvers", ())), *solvers])
    return {"settings": list(settings.values()), "solvers": [solvers[name] for name in order]}


def solver_label(solver: Mapping[str, Any]) -> str:
    """``interface:name`` of a solver of a study."""
    return f"{solver['interface']}:{solver['name']}"


def lasting(facts: Mapping[str, Any], shared: Sequence[str] | Mapping[str, Any]) -> dict[str, Any]:
    """Facts that both have, without those of the moment."""
    return {name: v for name, v in facts.items() if name in shared and name not in PASSING}
