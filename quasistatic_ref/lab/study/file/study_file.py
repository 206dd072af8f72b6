"""STUDY.toml: what is compared on what, read field by field; a mistake is one sentence."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.study.calling.sessions import MODES
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Setting, Solver
from quasistatic_ref.lab.study.file.fields import (
    COUNT,
    COUNTS,
    FORMAT,
    PROBLEMS,
    RUN,
    SETTING,
    STUDY,
    TABLES,
    VERSION,
)
from quasistatic_ref.lab.study.file.solver_lists import chosen_solvers, own_solvers
from quasistatic_ref.lab.study.problems.dials import MADE, SCENARIOS
from quasistatic_ref.lab.study.problems.for_study import TestSet
from quasistatic_ref.lab.study.problems.names import UNITS

GB = 1e9
"""[bytes]"""
QUICK = 20
"""By how much ``--quick`` divides the number of problems."""


@dataclass(frozen=True)
class Part:
    """One ``[[runs]]`` table: every solver at every setting, in all units, warm or cold.

    Parameters
    ----------
    solvers : tuple of Solver
    settings : tuple of Setting
    units : tuple of str
    warm : tuple of bool
    every : int
        3 runs every third problem, in a random order of all families.
    again : int
        10 runs every tenth of these once more, after all others; 0 none.
    modes : tuple of str
        Sequences of steps are solved in order, in these modes; none: each problem alone.
    """

    solvers: tuple[Solver, ...]
    settings: tuple[Setting, ...]
    units: tuple[str, ...]
    warm: tuple[bool, ...]
    every: int
    again: int
    modes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Limits:
    """What calls may take, as study files have it by default.

    Parameters
    ----------
    time_limit : float
        Of one call [s].
    warm_up : float
        Of the first call of a shape, at a setting, in a process, which is not counted [s].
    repetitions : int
        Calls of a measurement that are timed; more where they are short.
    budget : float
        Of one solver [s], for all its calls, and as much for its starts and its calls that warm up.
    memory : float
        Of one solver's processes [bytes].
    """

    time_limit: float = 2.0
    warm_up: float = 10.0
    repetitions: int = 5
    budget: float = 600.0
    memory: float = 4 * GB


@dataclass(frozen=True)
class Study:
    """A study file, read.

    Parameters
    ----------
    path : Path
    problems : TestSet
    limits : Limits
    parts : tuple of Part
    """

    path: Path
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
        own = own_solvers(top["solvers"], settings)
        parts = tuple(
            _part(TableReader(part, f"runs[{i}]"), settings, own)
            for i, part in enumerate(top["runs"])
        )
        limits = Limits(top["time_limit"], top["warm_up"], top["repetitions"], top["budget"],
                        top["memory"] * GB)  # fmt: skip
        return Study(path, problems, limits, parts)
    except InputError as error:
        raise error.in_file(path) from None


def _problems(table: TableReader, folder: Path, quick: bool) -> TestSet:
    given = TABLES.all_values(table, PROBLEMS)
    known = scenario_names()
    scenarios = known if given["scenarios"] is None else given["scenarios"]
    files = [name for name in scenarios if name.endswith(".toml")]
    _check_known(table, "scenarios", scenarios, [*known, *files])
    if len({Path(name).stem for name in scenarios}) < len(scenarios):
        raise table.error_about("scenarios", "must have different names", scenarios)
    scenarios = [str(folder / name) if name in files else name for name in scenarios]
    source = given["set"] or ""
    families, most = _counts(given["families"], bool(source))
    if quick:
        families = {name: -(-count // QUICK) for name, count in families.items()}
    if not sum(families.values()):
        raise table.error_about("families", "must name at least one problem")
    return TestSet(given["seed"], families, tuple(scenarios), source, most)


def _counts(table: TableReader, of_a_set: bool) -> tuple[dict[str, int], dict[str, float]]:
    """How many problems of each family, and where their dials end."""
    counts = {}
    most = {}
    for name, own in TABLES.all_values(table, COUNTS).items():
        inner = TableReader({"count": own} if isinstance(own, int) else own, table.name(name))
        count = TABLES.all_values(inner, COUNT)
        needs_set = name not in MADE and not of_a_set
        if count["count"] and needs_set and name != SCENARIOS:
            words = 'is a family of sets; say set = "contact-qp"'
            raise table.error_about(name, words)
        if count["most"] is not None and needs_set:
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
        given = TABLES.all_values(table, SETTING)
        if name not in settings and given["accuracy"] is None:
            raise table.error_about("accuracy", "is missing")
        was = settings.get(name, Setting(name, None))
        settings[name] = replace(was, **{k: v for k, v in given.items() if v is not None})
    return settings


def _part(table: TableReader, settings: Mapping[str, Setting], own: Mapping[str, Solver]) -> Part:
    given = TABLES.all_values(table, RUN)
    solvers = chosen_solvers(table, given["solvers"], own)
    names = given["settings"]
    _check_known(table, "settings", names, settings)
    _check_known(table, "units", given["units"], UNITS)
    _check_known(table, "modes", given["modes"], MODES)
    if not all(isinstance(warm, bool) for warm in given["warm"]):
        raise table.error_about("warm", "must be a list of true and false", given["warm"])
    for solver in solvers:
        if not any(solver.takes(settings[name]) for name in names):
            words = f"hold nothing that {solver.label} can be set to; add 'default', or give it"
            raise table.error_about("settings", f"{words} options of its own", names)
    return Part(
        solvers,
        tuple(settings[name] for name in dict.fromkeys(names)),
        tuple(dict.fromkeys(given["units"])),
        tuple(dict.fromkeys(given["warm"])),
        given["every"],
        given["again"],
        tuple(dict.fromkeys(given["modes"])),
    )


def _check_known(table: TableReader, field: str, names: list[str], known: Collection[str]) -> None:
    for name in names:
        if name not in known:
            raise table.error_about(field, f"holds an unknown one{suggestion(name, known)}", name)
