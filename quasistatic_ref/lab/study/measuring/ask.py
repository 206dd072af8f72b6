"""One solver run on one problem again, in a process of its own, and graded."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Setting, Solver
from quasistatic_ref.lab.study.file.fields import MODULE
from quasistatic_ref.lab.study.file.solver_lists import BY_INTERFACE, PACKAGE, solvers_named
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import measured_row
from quasistatic_ref.lab.study.problems.folder import MANIFEST, set_read
from quasistatic_ref.lab.study.problems.for_study import FOLDER
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.lab.study.store.continued import solver_label
from quasistatic_ref.lab.study.store.store import contents

OWN = ("callable", "executable", PACKAGE)
"""Interfaces of the solvers that a study file names."""


@dataclass(frozen=True, eq=False)
class Question:
    """One measurement, resolved.

    Parameters
    ----------
    problem : Problem
    solver : Solver
    setting : Setting
    units : str
    warm : bool
    limits : Limits
    """

    problem: Problem
    solver: Solver
    setting: Setting
    units: str
    warm: bool
    limits: Limits


def question(
    problem: str,
    solver: str,
    setting: str,
    units: str = "natural",
    warm: bool = False,
    store: str | Path | None = None,
) -> Question:
    """A measurement by its names.

    Parameters
    ----------
    problem : str
        Id: of the store, or of a set that comes along.
    solver : str
        ``interface:name`` as a report has it, ``module:function``, or a name of the study file.
    setting : str
    units : str
    warm : bool
    store : str or Path, optional
        Folder of a study, whose solvers, options and limits count; else the package's own.

    Raises
    ------
    InputError
        If there is no such problem, solver or setting, or the solver cannot start warm.
    """
    found = _problem(problem, store)
    if store is None:
        own = solver_named(solver)
        settings = list(SETTINGS)
        limits = Limits()
    else:
        study = contents(store).study
        own = _of_store(solver, study)
        settings = [Setting(**s) for s in study["settings"]]
        limits = Limits(**{one.name: study[one.name] for one in fields(Limits)})
    known = {one.name: one for one in settings if own.takes(one)}
    if setting not in known:
        hint = suggestion(setting, known)
        raise InputError(f"is not a setting that {own.label} takes{hint}", value=setting)
    if warm and not own.warm:
        raise InputError(f"cannot be used with {own.label}, which takes no start", field="--warm")
    return Question(found, own, known[setting], units, warm, limits)


def measured_again(one: Question) -> dict[str, Any]:
    """The fields of a row that are measured.

    Parameters
    ----------
    one : Question
        Callables and executables are looked for in the working directory.

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    with Keeper(one.solver, memory=one.limits.memory, settings=(one.setting,)) as keeper:
        return measured_row(keeper, one.problem, one.setting, one.units, one.warm, one.limits)


def _problem(name: str, store: str | Path | None) -> Problem:
    own = None if store is None else Path(store) / FOLDER
    if own is not None and (own / MANIFEST).exists():
        (found,) = set_read(own, ids=[name])
    else:
        found = _of_the_set(name)
    if found.facts["kind"] != QP:
        raise InputError("has cones; studies contain rows only", value=name)
    return found


def _of_the_set(name: str) -> Problem:
    """A problem of the set that comes along."""
    try:
        (found,) = set_read(problem_set_folder(CONTACT_QP), ids=[name])
    except InputError:
        words = f"is not a problem of {CONTACT_QP}; others need --store, the folder of a study that"
        raise InputError(f"{words} holds its problems", value=name) from None
    return found


def solver_named(label: str) -> Solver:
    """A solver of the package's table, or a callable.

    Raises
    ------
    InputError
        If the label is of neither form, or names no solver.
    """
    interface = label.partition(":")[0]
    if interface in (*BY_INTERFACE, PACKAGE):
        return solvers_named(label)[0]
    if not re.fullmatch(MODULE, label):
        words = "is neither interface:name nor module:function; a study's own need --store"
        raise InputError(words, value=label)
    return Solver(label.partition(":")[2], "callable", label)


def _of_store(label: str, study: Mapping[str, Any]) -> Solver:
    """A solver as it was called in a study, at the same options."""
    entries: Sequence[Mapping[str, Any]] = study["solvers"]
    names = {one["name"]: one for one in entries if one["interface"] in OWN}
    labels = {**names, **{solver_label(one): one for one in entries}}
    if label not in labels:
        raise InputError(f"is not a solver of the study{suggestion(label, labels)}", value=label)
    one = labels[label]
    target = one["target"]
    command = tuple(target) if isinstance(target, list) else target
    promised = {
        setting: own.get("digits", {name: said or False for name, said in own.items()})
        for setting, own in one["promise"].items()
    }
    return Solver(one["name"], one["interface"], command, one["options"], promised)
