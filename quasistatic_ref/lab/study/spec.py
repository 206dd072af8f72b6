"""STUDY.toml: what is compared on what, read field by field; a mistake is one sentence."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import bytes_read, text_of
from quasistatic_ref.lab.study.qp import UNITS
from quasistatic_ref.lab.study.solvers import SETTINGS, Setting, Solver
from quasistatic_ref.lab.study.spec_solvers import chosen_solvers, own_solvers
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.resources import scenario_names
from quasistatic_ref.simulate.settings import toml_tables

FORMAT, VERSION = "quasistatic-ref/study", 1
KINDS = ("solvers", "sweep")
LARGEST = 2**20
"""Largest study file [bytes]."""
FAMILIES = ("scenarios", "contacts", "mass_ratio", "time_step", "closest_points", "bodies")
MOST_PROBLEMS = 100_000
QUICK = 20
"""By how much ``--quick`` divides the number of problems."""


@dataclass(frozen=True)
class TestSet:
    """Which problems.

    Parameters
    ----------
    seed : int
    families : mapping of str to int
        Number of problems of each.
    scenarios : tuple of str
        Those that are harvested.
    """

    __test__ = False  # no test of pytest's

    seed: int
    families: Mapping[str, int]
    scenarios: tuple[str, ...]


@dataclass(frozen=True)
class Part:
    """One ``[[runs]]`` table: every solver at every setting, in all units, warm or cold.

    Parameters
    ----------
    solvers : tuple of Solver
    settings : tuple of Setting
    units : tuple of str
    warm : tuple of bool
    repetitions : int
    every : int
        3 asks every third problem, in a random order of all families.
    """

    solvers: tuple[Solver, ...]
    settings: tuple[Setting, ...]
    units: tuple[str, ...]
    warm: tuple[bool, ...]
    repetitions: int
    every: int


@dataclass(frozen=True)
class Study:
    """A study file, read.

    Parameters
    ----------
    path : Path
    problems : TestSet
    time_limit : float
        Of one problem [s].
    budget : float
        Of one solver, all its calls together [s].
    parts : tuple of Part
    """

    path: Path
    problems: TestSet
    time_limit: float
    budget: float
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


def study_tables(path: Path) -> dict[str, Any]:
    """The tables of a study file as they stand in it.

    Raises
    ------
    InputError
        If it is missing or not TOML.
    """
    try:
        return toml_tables(text_of(bytes_read(path, largest=LARGEST), path))
    except InputError as error:
        raise error.in_file(path) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is not TOML: {error}", file=path) from None
    except (RecursionError, ValueError):
        raise InputError("is nested too deeply, or holds an unusable number", file=path) from None


def study_kind(tables: dict[str, Any]) -> str:
    """``"solvers"`` or ``"sweep"``."""
    return Fields(dict(tables)).text("kind", "solvers", KINDS)


def header(top: Fields) -> None:
    """Read ``format``, ``version`` and ``kind``, which both kinds of study begin with."""
    top.check_format(FORMAT, VERSION)
    top.text("kind", "solvers", KINDS)


def solver_study(path: Path, tables: dict[str, Any], quick: bool = False) -> Study:
    """A study of solvers from its tables.

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
        top = Fields(tables)
        header(top)
        problems = _problems(top.table("problems", {}), quick)
        limit = top.number("time_limit", 2.0, above=0.0)
        budget = top.number("budget", 600.0, above=0.0)
        settings = _settings(top.table("settings", {}))
        own = own_solvers(top.table("solvers", {}), settings)
        parts = tuple(
            _part(Fields(part, f"runs[{i}]"), settings, own)
            for i, part in enumerate(top.sequence("runs", [{}]))
        )
        top.close()
        if not parts:
            raise top.fail("runs", "must hold at least one table")
        return Study(path, problems, limit, budget, parts)
    except InputError as error:
        raise error.in_file(path) from None


def _problems(table: Fields, quick: bool) -> TestSet:
    seed = table.integer("seed", 1, least=0, most=2**32 - 1)
    known = scenario_names()
    scenarios = table.words("scenarios", known)
    for name in scenarios:
        if name not in known:
            raise table.fail("scenarios", f"holds no scenario{suggestion(str(name), known)}", name)
    counts = table.table("families", {"scenarios": 20})
    families = {name: counts.integer(name, 0, least=0, most=MOST_PROBLEMS) for name in FAMILIES}
    counts.close()
    table.close()
    if quick:
        families = {name: -(-count // QUICK) for name, count in families.items()}
    if not sum(families.values()):
        raise table.fail("families", "must name at least one problem")
    return TestSet(seed, families, tuple(scenarios))


def _settings(tables: Fields) -> dict[str, Setting]:
    settings = {s.name: s for s in SETTINGS}
    for name in tables.names():
        table, was = tables.table(name), settings.get(name)
        if was is None or "accuracy" in table:
            accuracy: float | None = table.number("accuracy", above=0.0)
        else:
            accuracy = was.accuracy
        promised = table.number("promised", was.promised if was else 3.0, least=0.0)
        tuned = table.boolean("tuned", bool(was and was.tuned))
        table.close()
        settings[name] = Setting(name, accuracy, float(promised), tuned)
    return settings


def _part(table: Fields, settings: Mapping[str, Setting], own: Mapping[str, Solver]) -> Part:
    asked = table.words("solvers", ["qpsolvers:*"])
    solvers = chosen_solvers(table, asked, own)
    names = table.words("settings", ["default"])
    for name in names:
        if name not in settings:
            hint = suggestion(str(name), settings)
            raise table.fail("settings", f"holds an unknown one{hint}", name)
    units = table.words("units", ["natural"])
    for name in units:
        if name not in UNITS:
            raise table.fail("units", f"must be among {', '.join(UNITS)}", name)
    warm = table.sequence("warm", [False])
    if not warm or not all(isinstance(w, bool) for w in warm):
        raise table.fail("warm", "must be a list of true and false", warm)
    repetitions = table.integer("repetitions", 1, least=1, most=1000)
    every = table.integer("every", 1, least=1)
    table.close()
    if not names or not units:
        raise table.fail("settings" if not names else "units", "must not be empty")
    for solver in solvers:
        if not any(solver.takes(settings[name]) for name in names):
            words = f"hold nothing that {solver.label} can be set to; add 'default', or give it"
            raise table.fail("settings", f"{words} options of its own", names)
    return Part(
        solvers,
        tuple(settings[name] for name in dict.fromkeys(names)),
        tuple(dict.fromkeys(units)),
        tuple(dict.fromkeys(warm)),
        repetitions,
        every,
    )
