"""The sentences of a report: method, limitations, where it ran."""

import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.study.report.numbers import options_words
from quasistatic_ref.lab.study.report.statistics import SHIFT


@cache
def _words() -> dict[str, list[str]]:
    """The sentences, by what they are about."""
    return tomllib.loads((Path(__file__).parent / "words.toml").read_text(encoding="utf-8"))


def method(limit: float) -> list[str]:
    """How everything was measured, with the time limit of a problem [s]."""
    return [words.format(limit=limit, shift=1e3 * SHIFT) for words in _words()["method"]]


def limitations() -> list[str]:
    """What the numbers of a study of solvers do not say."""
    return _words()["limitations"]


def sweep_method() -> list[str]:
    """How a sweep was measured, and what its numbers do not say."""
    return _words()["sweep"]


def place_tables(study: Mapping[str, Any]) -> tuple[Table, Table]:
    """Machine and versions."""
    names = study.get("machines", [])
    tables = []
    for title, field, first, one in (
        ("Machine", "machine", "what", "which"),
        ("Versions", "versions", "package", "version"),
    ):
        parts = [study[field][name] for name in names] if names else [study[field]]
        lines = tuple(
            (str(key), *(str(part.get(key, "-")) for part in parts))
            for key in dict.fromkeys(key for part in parts for key in part)
        )
        columns = (first, *(names or [one]))
        tables.append(Table(f"{title}.", f"the store, {field}", columns, lines, len(columns)))
    return tables[0], tables[1]


def options_table(solvers: Sequence[Mapping[str, Any]]) -> Table:
    """Every solver's options at every setting."""
    rows = tuple(
        (s["name"], s["interface"], setting, f"`{options_words(options)}`")
        for s in solvers
        for setting, options in s["options"].items()
    )
    names = ("solver", "interface", "setting", "its own options")
    return Table("Options.", "the store, options", names, rows, left=4)


def settings_table(settings: Sequence[Mapping[str, Any]]) -> Table:
    """What the settings require and promise."""
    rows = tuple(
        (s["name"], "its own" if s["accuracy"] is None else f"{s['accuracy']:g}",
         f"{s['promised']:g}", "the simulator's" if s["tuned"] else "plain")
        for s in settings
    )  # fmt: skip
    names = ("setting", "accuracy", "digits promised", "options")
    return Table("The settings.", "the store, settings", names, rows)
