"""A study that goes on in its folder: what may have changed since it was begun, and what not."""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.errors import InputError

FREE = ("runs",)
"""What may change in the study file: rows that it no longer contains stay."""
PASSING = ("load",)
"""What is of the moment, and not of the machine."""


def continued(there: Mapping[str, Any], wanted: Mapping[str, Any]) -> dict[str, Any]:
    """``study.json`` of a study that goes on: solvers may come, and go.

    Parameters
    ----------
    there : mapping
        What the folder holds.
    wanted : mapping
        What the study file gives today.

    Returns
    -------
    dict
        `wanted`, with the settings, versions and machine of the rows that are there; ``removed``
        names the solvers that had rows and are no longer in the study.

    Raises
    ------
    InputError
        If rows of today could not be compared with those that are there.
    """
    merged = dict(wanted)
    for name, value in wanted.items():
        old: Any = there.get(name)
        if name in FREE or (name == "removed" and not value):
            continue
        if name == "solvers":
            merged[name] = [_same_solver(_named(old, solver), solver) for solver in value]
        elif name == "settings":
            merged[name] = _settings(old, value)
        elif name in ("versions", "machine"):
            if any(old[k] != v for k, v in value.items() if k in old and k not in PASSING):
                raise _another(name)
            merged[name] = {**value, **old}
        elif old != value:
            raise _another(name)
    if "solvers" in wanted:
        labels = {_label(solver) for solver in wanted["solvers"]}
        before = [*map(_label, there["solvers"]), *there.get("removed", [])]
        merged["removed"] = [label for label in dict.fromkeys(before) if label not in labels]
    return merged


def _label(solver: Mapping[str, Any]) -> str:
    return f"{solver['interface']}:{solver['name']}"


def _named(solvers: Any, like: Mapping[str, Any]) -> Mapping[str, Any] | None:
    return next((s for s in solvers if _label(s) == _label(like)), None)


def _same_solver(old: Mapping[str, Any] | None, new: Mapping[str, Any]) -> dict[str, Any]:
    """A solver with the options of every setting that it was ever called with."""
    if old is None:
        return dict(new)
    shared = {name: options for name, options in new["options"].items() if name in old["options"]}
    if old.get("target") != new["target"] or any(old["options"][n] != o for n, o in shared.items()):
        raise _another(f"solvers.{_label(new)}")
    return {**new, "options": {**old["options"], **new["options"]}}


def _settings(old: Any, new: Any) -> list[Any]:
    names = {setting["name"]: setting for setting in old}
    if any(names.get(s["name"], s) != s for s in new):
        raise _another("settings")
    return list((names | {s["name"]: s for s in new}).values())


def _another(name: str) -> InputError:
    return InputError(
        f"holds a study that was begun with another {name!r}; choose another folder with --out, "
        "or remove this one"
    )
