"""The tables of what a study was: its problems, the machine, and the options of each solver."""

from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.study.calling.options import option_file, takes_sparse
from quasistatic_ref.lab.study.calling.promises import promise_words
from quasistatic_ref.lab.study.report.words import options_words

FACTS = ("n", "m", "contacts", "h", "mass_ratio", "condition", "condition_natural")
"""Numbers of a problem whose smallest and largest are shown."""


def problem_table(facts: Sequence[Mapping[str, Any]]) -> Table:
    """What the problems are."""
    families: dict[str, list[Mapping[str, Any]]] = {}
    for fact in facts:
        families.setdefault(fact["family"], []).append(fact)
    rows = tuple(
        (family, str(len(own)), str(sum(f["kind"] == "exact" for f in own)),
         *(_span([f[name] for f in own if f[name] is not None]) for name in FACTS))
        for family, own in families.items()
    )  # fmt: skip
    names = ("family", "problems", "exact answers", "coordinates n", "rows m", "contacts",
             "h [s]", "mass ratio", "condition of H, raw", "condition of H, natural")  # fmt: skip
    return Table("The problems.", "the store, problems", names, rows)


def _span(values: Sequence[float]) -> str:
    if not values:
        return "-"
    low, high = (f"{v:.0f}" if 10 <= v < 1e4 else f"{v:.2g}" for v in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def place_tables(study: Mapping[str, Any]) -> list[Table]:
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
    return tables


def options_table(solvers: Sequence[Mapping[str, Any]]) -> Table:
    """Every solver's options at every setting, and what they promise."""
    rows = tuple(
        (s["name"], s["interface"], setting, f"`{options_words(options)}`",
         option_file(str(s["target"])).get("source", "-"), promise_words(s["promise"][setting]),
         "as they are" if takes_sparse(str(s["target"]), s["interface"]) else "as arrays")
        for s in solvers
        for setting, options in s["options"].items()
    )  # fmt: skip
    names = ("solver", "interface", "setting", "its own options", "documented at", "promised",
             "sparse matrices")  # fmt: skip
    return Table("Options.", "the store, options", names, rows, left=7)
