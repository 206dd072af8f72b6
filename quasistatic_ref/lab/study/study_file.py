"""STUDY.toml: what is compared on what, read field by field; a mistake is one sentence."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.study.fields import (
    COUNT,
    COUNTS,
    FORMAT,
    PROBLEMS,
    RUN,
    SETTING,
    SOLVER,
    STARTS,
    STUDY,
    TABLES,
    VERSION,
)
from quasistatic_ref.lab.study.problems.dials import SCENARIOS
from quasistatic_ref.lab.study.problems.for_study import TestSet
from quasistatic_ref.lab.study.problems.names import UNITS
from quasistatic_ref.lab.study.promises import promise_stated
from quasistatic_ref.lab.study.solvers import (
    DOORS,
    FUNCTION,
    SETTINGS,
    Setting,
    Solver,
    check_installed,
    solvers_named,
)

GB = 1e9
"""[bytes]"""
QUICK = 20
"""By how much ``--quick`` divides the number of problems."""


@dataclass(frozen=True)
class Part:
    """One ``[[runs]]`` table: every solver at every setting, in all units, from all starts.

    Parameters
    ----------
    solvers : tuple of Solver
    settings : tuple of Setting
    units, starts : tuple of str
    every : int
        3 runs every third problem, in a random order of all families.
    """

    solvers: tuple[Solver, ...]
    settings: tuple[Setting, ...]
    units: tuple[str, ...]
    starts: tuple[str, ...]
    every: int


@dataclass(frozen=True)
class Limits:
    """What calls may take.

    Parameters
    ----------
    time_limit : float
        Of one call [s].
    warm_up : float
        Of the first call of a shape, at a setting, in a process, which is not counted [s].
    repetitions : int
        Calls of a measurement that are timed.
    budget : float
        Of one solver, all its calls together [s].
    memory : float
        Of one solver's process [bytes].
    """

    time_limit: float
    warm_up: float
    repetitions: int
    budget: float
    memory: float


@dataclass(frozen=True)
class Study:
    """A study file, read.

    Parameters
    ----------
    folder : str
        In which it is: where files of functions are looked for.
    problems : TestSet
    limits : Limits
    parts : tuple of Part
    """

    folder: str
    problems: TestSet
    limits: Limits
    parts: tuple[Part, ...]

    @property
    def solvers(self) -> tuple[Solver, ...]:
        """Every solver of the study, once."""
        return tuple({s.label: s for part in self.parts for s in part.solvers}.values())

    @property
    def settings(self) -> tuple[Setting, ...]:
        """Every setting of the study, once."""
        return tuple({s.name: s for part in self.parts for s in part.settings}.values())


def study_names() -> dict[str, Path]:
    """The studies that come with the package, by name."""
    return {path.stem: path for path in (Path(__file__).parent / "studies").glob("*.toml")}


def study_path(name: str | Path) -> Path:
    """A study file: a path as it is, or the name of one that comes with the package.

    Raises
    ------
    InputError
        If there is neither such a file nor such a name.
    """
    path = Path(name)
    if path.suffix == ".toml":
        return path
    known = study_names()
    if str(name) not in known:
        hint = suggestion(str(name), known)
        raise InputError(f"is neither a file nor a study that comes along{hint}", file=name)
    return known[str(name)]


def solver_study(path: Path, tables: dict[str, Any], quick: bool = False) -> Study:
    """A study from its tables.

    Parameters
    ----------
    path : Path
    tables : dict
    quick : bool
        A twentieth of the problems, each family keeping one.

    Raises
    ------
    InputError
        Naming the file, the field and the value.
    """
    try:
        if {"format", "version"} <= tables.keys():  # another format's names are no mistakes
            TableReader(tables).check_format(FORMAT, VERSION)
        top = TABLES.all_values(TableReader(tables), STUDY)
        problems = _problems(top["problems"], path.parent, quick)
        settings = _settings(top["settings"])
        defined = {
            name: _solver(name, top["solvers"], settings) for name in top["solvers"].names_left()
        }
        parts = tuple(
            _part(TableReader(part, f"runs[{i}]"), settings, defined)
            for i, part in enumerate(top["runs"])
        )
        limits = Limits(top["time_limit"], top["warm_up"], top["repetitions"], top["budget"],
                        top["memory"] * GB)  # fmt: skip
        return Study(str(path.resolve().parent), problems, limits, parts)
    except InputError as error:
        raise error.in_file(path) from None


def _problems(table: TableReader, folder: Path, quick: bool) -> TestSet:
    values = TABLES.all_values(table, PROBLEMS)
    known = scenario_names()
    scenarios = known if values["scenarios"] is None else values["scenarios"]
    files = [name for name in scenarios if name.endswith(".toml")]
    _check_known(table, "scenarios", scenarios, [*known, *files])
    if len({Path(name).stem for name in scenarios}) < len(scenarios):
        raise table.error_about("scenarios", "must have different names", scenarios)
    scenarios = [str(folder / name) if name in files else name for name in scenarios]
    source = values["set"] or ""
    families, most = _counts(values["families"], bool(source))
    if quick:
        families = {name: -(-count // QUICK) for name, count in families.items()}
    if not sum(families.values()):
        raise table.error_about("families", "must name at least one problem")
    return TestSet(families, tuple(scenarios), source, most)


def _counts(table: TableReader, of_a_set: bool) -> tuple[dict[str, int], dict[str, float]]:
    """How many problems of each family, and where their dials end."""
    counts = {}
    most = {}
    for name, entry in TABLES.all_values(table, COUNTS).items():
        inner = TableReader({"count": entry} if isinstance(entry, int) else entry, table.name(name))
        count = TABLES.all_values(inner, COUNT)
        if count["count"] and name != SCENARIOS and not of_a_set:
            raise table.error_about(name, 'is a family of sets; say set = "contact-qp"')
        if count["most"] is not None and not of_a_set:
            raise table.error_about(name, "has no dial to be turned, unless it is taken from a set")
        if count["count"]:
            counts[name] = count["count"]
        if count["most"] is not None:
            most[name] = count["most"]
    return counts, most


def _settings(tables: TableReader) -> dict[str, Setting]:
    settings = {s.name: s for s in SETTINGS}
    for name in tables.names_left():
        table = tables.table(name)
        values = TABLES.all_values(table, SETTING)
        if name not in settings and values["accuracy"] is None:
            raise table.error_about("accuracy", "is missing")
        was = settings.get(name, Setting(name, None))
        settings[name] = replace(was, **{k: v for k, v in values.items() if v is not None})
    return settings


def _solver(name: str, tables: TableReader, settings: Mapping[str, Setting]) -> Solver:
    """One that the study defines."""
    table = tables.table(name)
    values = TABLES.all_values(table, SOLVER)
    doors = [door for door in DOORS if values[door] is not None]
    if len(doors) != 1:
        words = "must say one of qpsolvers, cvxpy and function"
        raise tables.error_about(name, words, doors or None)
    (door,) = doors
    target = str(values[door])
    if door == FUNCTION:
        if not target.rpartition(":")[0]:
            raise table.error_about(door, "must read FILE.py:FUNCTION or MODULE:FUNCTION", target)
    else:
        try:
            check_installed(door, target)
        except InputError as error:
            raise table.error_about(door, error.problem, target) from None
    options = _by_setting(values["options"], settings)
    promised = _by_setting(values["promised"], settings)
    for setting, value in promised.items():
        try:
            promise_stated(value)
        except (ValueError, TypeError, KeyError) as error:
            words = "must be a table of primal, dual and gap, each a number or a table of abs, rel"
            wrong = values["promised"].error_about(setting, f"{words} and of: {error}", value)
            raise wrong from None
    return Solver(name, door, target, options, promised)


def _by_setting(tables: TableReader, settings: Mapping[str, Setting]) -> dict[str, dict[str, Any]]:
    """Tables of options, or of promises, by the names of settings."""
    by_setting = {}
    for name in tables.names_left():
        if name not in settings:
            raise tables.error_about(name, f"is not a setting{suggestion(name, settings)}")
        value = tables.take(name)
        if not isinstance(value, dict):
            raise tables.error_about(name, "must be a table", value)
        by_setting[name] = value
    return by_setting


def _part(
    table: TableReader, settings: Mapping[str, Setting], defined: Mapping[str, Solver]
) -> Part:
    values = TABLES.all_values(table, RUN)
    chosen: dict[str, Solver] = {}
    for name in values["solvers"]:
        try:
            some = [defined[name]] if name in defined else solvers_named(name)
        except InputError as error:
            raise table.error_about("solvers", error.problem, error.value) from None
        chosen |= {solver.label: solver for solver in some}
    names = values["settings"]
    _check_known(table, "settings", names, settings)
    _check_known(table, "units", values["units"], UNITS)
    _check_known(table, "starts", values["starts"], STARTS)
    for solver in chosen.values():
        if not any(solver.takes(settings[name]) for name in names):
            words = f"hold nothing that {solver.label} can be set to; add 'default', or give it"
            raise table.error_about("settings", f"{words} options of its own", names)
    return Part(
        tuple(chosen.values()),
        tuple(settings[name] for name in dict.fromkeys(names)),
        tuple(dict.fromkeys(values["units"])),
        tuple(dict.fromkeys(values["starts"])),
        values["every"],
    )


def _check_known(table: TableReader, field: str, names: list[str], known: Collection[str]) -> None:
    for name in names:
        if name not in known:
            raise table.error_about(field, f"holds an unknown one{suggestion(name, known)}", name)
