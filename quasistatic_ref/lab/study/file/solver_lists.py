"""The ``[solvers.NAME]`` tables of a study, and the lists that choose among solvers."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.study.calling.packages import announced_solvers, entry_of
from quasistatic_ref.lab.study.calling.promises import promise_stated
from quasistatic_ref.lab.study.calling.solvers import INTERFACES, Setting, Solver
from quasistatic_ref.lab.study.calling.study_only import EVERY, installed_here, known_to
from quasistatic_ref.lab.study.file.fields import MODULE, SOLVER, TABLES

PACKAGE = "package"
BY_INTERFACE = {interface: known_to(interface) for interface in ("cvxpy", "qpsolvers", "native")}


def own_solvers(tables: TableReader, settings: Mapping[str, Setting]) -> dict[str, Solver]:
    """The solvers that a study defines, by name.

    Raises
    ------
    InputError
        If a table names no interface, or more than one.
    """
    solvers = {}
    for name in tables.names_left():
        table = tables.table(name)
        given = TABLES.all_values(table, SOLVER)
        interfaces = [interface for interface in INTERFACES if given[interface] is not None]
        if len(interfaces) != 1:
            words = "must say one of cvxpy, qpsolvers, native, package, callable and executable"
            raise tables.error_about(name, words, interfaces or None)
        (interface,) = interfaces
        target = _target(table, interface, given[interface])
        options = _options(given["options"], settings)
        promised = _promises(given["promised"], settings)
        solvers[name] = Solver(name, interface, target, options, promised)
    return solvers


def chosen_solvers(
    table: TableReader, names: list[str], own: Mapping[str, Solver]
) -> tuple[Solver, ...]:
    """The solvers of a list: names of the study's own, ``interface:name``, and ``interface:*``.

    Raises
    ------
    InputError
        If a name is unknown, or its solver is not installed.
    """
    chosen: dict[str, Solver] = {}
    for name in names:
        if name in own:
            found = [own[name]]
        else:
            try:
                found = solvers_named(name, own)
            except InputError as error:
                raise table.error_about("solvers", error.problem, error.value) from None
        chosen |= {solver.label: solver for solver in found}
    return tuple(chosen.values())


def solvers_named(name: str, own: Iterable[str] = ()) -> list[Solver]:
    """The solvers of ``interface:name``, or all that are installed of ``interface:*``.

    Parameters
    ----------
    name : str
    own : iterable of str
        Other names that would have been understood.

    Raises
    ------
    InputError
        If a name is unknown, or its solver is not installed.
    """
    interface, _, solver = name.partition(":")
    if interface == PACKAGE:
        names = list(announced_solvers()) if solver == "*" else [solver]
        return [Solver(entry_of(one).name, PACKAGE, one) for one in names]
    if interface not in BY_INTERFACE:
        known = [*own, *(f"{r}:*" for r in (*BY_INTERFACE, PACKAGE))]
        raise InputError(f"holds no solver{suggestion(name, known)}", value=name)
    everyone = installed_here(interface) if solver == "*" else (solver,)
    for one in everyone:
        _check_installed(interface, one)
    return [Solver(one, interface, one) for one in everyone]


def _check_installed(interface: str, solver: str) -> None:
    if solver not in BY_INTERFACE[interface]:
        hint = suggestion(solver, BY_INTERFACE[interface])
        raise InputError(f"holds no solver of {interface}{hint}", value=solver)
    if solver not in installed_here(interface):
        remedy = EVERY[solver].to_install_it
        raise InputError(f"is not installed; {remedy}", value=solver)


def _target(table: TableReader, interface: str, given: Any) -> str | tuple[str, ...]:
    if interface == "executable":
        return tuple(given)
    if interface == "callable":
        if not re.fullmatch(MODULE, given):
            raise table.error_about(interface, "must read module:function", given)
        return str(given)
    try:
        if interface == PACKAGE:
            entry_of(given)
        else:
            _check_installed(interface, given)
    except InputError as error:
        raise table.error_about(interface, error.problem, given) from None
    return str(given)


def _promises(tables: TableReader, settings: Mapping[str, Setting]) -> dict[str, Any]:
    promised = {}
    for name in tables.names_left():
        if name not in settings:
            raise tables.error_about(name, f"is not a setting{suggestion(name, settings)}")
        value = tables.take(name)
        try:
            promised[name] = promise_stated(value)
        except (ValueError, TypeError, KeyError) as error:
            words = "must be digits, or a table of primal, dual and gap, each a number or a table"
            raise tables.error_about(name, f"{words} of abs, rel and of: {error}", value) from None
    return promised


def _options(tables: TableReader, settings: Mapping[str, Setting]) -> dict[str, dict[str, Any]]:
    options = {}
    for name in tables.names_left():
        if name not in settings:
            raise tables.error_about(name, f"is not a setting{suggestion(name, settings)}")
        value = tables.take(name)
        if not isinstance(value, dict):
            raise tables.error_about(name, "must be a table of options", value)
        options[name] = value
    return options
