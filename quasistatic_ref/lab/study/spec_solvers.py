"""The ``[solvers.NAME]`` tables of a study, and the lists that choose among solvers."""

import re
from collections.abc import Mapping
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.fields import Fields
from quasistatic_ref.lab.study.solvers import ROADS, Setting, Solver
from quasistatic_ref.lab.study.spec_table import MODULE, SOLVER, TABLES
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.solve.backends import BACKENDS, installed

BY_ROAD = {"cvxpy": [b.name for b in BACKENDS.values() if b.cvxpy], "qpsolvers": list(BACKENDS)}


def own_solvers(tables: Fields, settings: Mapping[str, Setting]) -> dict[str, Solver]:
    """The solvers that a study defines, by name.

    Raises
    ------
    InputError
        If a table names no road, or more than one.
    """
    solvers = {}
    for name in tables.names():
        table = tables.table(name)
        given = TABLES.all_values(table, SOLVER)
        roads = [road for road in ROADS if given[road] is not None]
        if len(roads) != 1:
            words = "must say one of cvxpy, qpsolvers, callable and executable"
            raise tables.fail(name, words, roads or None)
        (road,) = roads
        target, options = _target(table, road, given[road]), _options(given["options"], settings)
        solvers[name] = Solver(name, road, target, options)
    return solvers


def chosen_solvers(
    table: Fields, names: list[str], own: Mapping[str, Solver]
) -> tuple[Solver, ...]:
    """The solvers of a list: names of the study's own, ``road:name``, and ``road:*``.

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
            road, _, solver = name.partition(":")
            if road not in BY_ROAD:
                known = [*own, *(f"{r}:*" for r in BY_ROAD)]
                raise table.fail("solvers", f"holds no solver{suggestion(name, known)}", name)
            everyone = installed(road) if solver == "*" else (solver,)
            for one in everyone:
                _check_installed(table, road, one)
            found = [Solver(one, road, one) for one in everyone]
        chosen |= {solver.label: solver for solver in found}
    return tuple(chosen.values())


def _check_installed(table: Fields, road: str, solver: str) -> None:
    if solver not in BY_ROAD[road]:
        hint = suggestion(solver, BY_ROAD[road])
        raise table.fail("solvers", f"holds no solver of {road}{hint}", solver)
    if solver not in installed(road):
        remedy = BACKENDS[solver].to_install_it
        raise table.fail("solvers", f"is not installed; {remedy}", solver)


def _target(table: Fields, road: str, given: Any) -> str | tuple[str, ...]:
    if road == "executable":
        return tuple(given)
    if road == "callable":
        if not re.fullmatch(MODULE, given):
            raise table.fail(road, "must read module:function", given)
        return str(given)
    try:
        _check_installed(table, road, given)
    except InputError as error:
        raise table.fail(road, error.problem, given) from None
    return str(given)


def _options(tables: Fields, settings: Mapping[str, Setting]) -> dict[str, dict[str, Any]]:
    options = {}
    for name in tables.names():
        if name not in settings:
            raise tables.fail(name, f"is no setting{suggestion(name, settings)}")
        value = tables.take(name)
        if not isinstance(value, dict):
            raise tables.fail(name, "must be a table of options", value)
        options[name] = value
    return options
