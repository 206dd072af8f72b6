"""What the committed study of solvers says to a user who chooses one, sentence by sentence.

``advice(found)`` is the text that docs/solver_study.md shows: every number in it, and every
solver, setting and family that it names, comes from the rows.
``python -m validation.make.study_reports`` writes it next to the report.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.page.parts import Report, Section, Table
from quasistatic_ref.lab.study.file.study_file import solver_study, study_path
from quasistatic_ref.lab.study.measuring.environment import UNKNOWN
from quasistatic_ref.lab.study.report.comparison import WANTED, Comparison, Soonest, comparison_of
from quasistatic_ref.lab.study.report.rows import Rows, rows_of
from quasistatic_ref.lab.study.report.statistics import success
from quasistatic_ref.lab.study.report.tables import LIMITS, headline
from quasistatic_ref.lab.study.report.words import milliseconds, options_words, tenths
from quasistatic_ref.lab.study.store.store import Contents

NAME = "advice.md"
HARDEST = 2
"""Families that are named."""
FALSE = 1.0
"""Share of false claims from which a solver's own setting is advised against [%]."""


def advice(found: Contents) -> str:
    """The text, in Markdown, of what a store holds."""
    study, rows = found.study, found.rows
    every = rows_of(rows, study["time_limit"])
    comparison = comparison_of(study, every)
    first = every.at(repetition=0)
    parts = [
        " ".join(_extent(comparison, study)),
        "## What to use",
        *filter(None, [comparison.busy]),
        _headline(comparison),
        "\n".join(_bullet(one, comparison) for one in comparison.fastest()),
        "## What else it shows",
        *_others(comparison, first),
        "## How it ran",
        " ".join(_trust(first, rows, study)),
    ]
    return "\n\n".join(parts) + "\n"


def _extent(comparison: Comparison, study: dict) -> Iterator[str]:
    problems, own = study["problems"], comparison.rows
    yield f"{problems['count']:,} problems of {len(problems['families'])} families,"
    yield f"{problems['exact']:,} of them with exact answers."
    names = {"qpsolvers": "called directly", "cvxpy": "through CVXPY", "native": "natively"}
    counts = [
        f"{len(set(part['solver'])):,} {names.get(interface, 'as ' + interface)}"
        for (interface,), part in own.groups("interface").items()
    ]
    yield f"Solvers: {', '.join(counts)}; {len(comparison.settings)} settings; {len(own):,} calls."
    path = study_path("default")
    if solver_study(path, toml_read(path)).problems.families != problems["families"]:
        yield "The problems of these rows are an earlier selection than that of today's study file."


def _headline(comparison: Comparison) -> str:
    """The solvers of the report's table, each by the interface with the soonest 6 digits."""
    table = headline(comparison.fastest(), comparison)
    page = markdown_page(Report("", (Section("", (table,)),)))
    return page[page.index("**Each") :].strip()


def _bullet(one: Soonest, comparison: Comparison) -> str:
    """A solver: what to set, what that delivers, what not to do, what is hard for it."""
    own, label = one.rows, one.label
    options = comparison.options[own.first("way")]
    words = [
        f"- **{label}** at `{one.setting}` (`{options_words(options[one.setting], LIMITS)}`) "
        f"delivers 6 digits on {tenths(success(own['digits'], 6.0))} % and 9 digits on "
        f"{tenths(success(own['digits'], 9.0))} % of {len(own):,} problems, in "
        f"{milliseconds(float(np.median(own['seconds'])))} ms (median); {_false(own)}."
    ]
    plain = comparison.called.at(setting="default", label=label, half=1)
    if one.setting != "default" and plain:
        wrong, said = plain["wrong"] & plain["said_optimal"], plain["said_optimal"]
        much = 100 * int(wrong.sum()) > FALSE * int(said.sum())
        advised = "is not advised: it delivers" if much else "delivers"
        words.append(
            f"Its own setting {advised} 6 digits on {tenths(success(plain['digits'], 6.0))} % of "
            f"the problems; {_false(plain)}."
        )
    bad = own.kept(lambda row: row["digits"] < WANTED)
    if bad:
        families, counts = np.unique(bad["family"], return_counts=True)
        order = np.lexsort((families, -counts))[:HARDEST]
        named = " and ".join(f"{counts[i]} of `{families[i]}`" for i in order)
        noun = "problem" if len(bad) == 1 else "problems"
        words.append(
            f"At `{one.setting}` the solver misses 6 digits on {len(bad):,} {noun}, among them "
            f"{named}."
        )
    if one.missing:
        words.append(f"Its budget did not reach {one.missing:,} problems, which are left out.")
    return " ".join(words)


def _false(part: Rows) -> str:
    said, wrong = part["said_optimal"], part["wrong"]
    none = int((wrong & part["said_infeasible"]).sum())
    words = f"{int((said & wrong).sum()):,} of {int(said.sum()):,} claims of success are false"
    return words + (f", and the solver calls {none:,} solvable problems infeasible" if none else "")


def _others(comparison: Comparison, first: Rows) -> Iterator[str]:
    said, none, wrong = (first[n] for n in ("said_optimal", "said_infeasible", "wrong"))
    yield (
        f"**A status is not evidence.** Of {int(said.sum()):,} claims of success, "
        f"{int((said & wrong).sum()):,} are false; of {int(none.sum()):,} claims that there is no "
        f"solution, {int((none & wrong).sum()):,} are false."
    )
    yield "**Units come before options.** Share of problems with 6 digits, with the same options:"
    yield _units_table(comparison)
    yield (
        "**An accuracy of 10^-2k promises about k digits.** By strong convexity, a duality gap of "
        "eps bounds the error of a feasible pair by sqrt(2 eps); tolerances of residuals bound no "
        "error. Median of the correct digits, of solvers called directly and cold, in natural "
        "units:"
    )
    yield _accuracy_table(comparison)
    if words := _cvxpy(comparison):
        yield f"**CVXPY costs time, and chooses defaults of its own.** {words}"


def _units_table(comparison: Comparison) -> str:
    lines = []
    cold = comparison.rows.at(warm=False, interface="qpsolvers")
    for (solver, setting), part in cold.groups("solver", "setting").items():
        own = part.common("units")
        parts = [own.at(units=units) for units in ("raw", "natural")]
        if setting in ("default", "high") and all(parts):
            shares = [tenths(success(p["digits"], 6.0)) for p in parts]
            lines.append((solver, setting, str(len(parts[0])), *shares))
    names = ("solver", "setting", "problems", "raw [%]", "natural [%]")
    return table_text(names, sorted(lines), 2)


def _accuracy_table(comparison: Comparison) -> str:
    direct = comparison.rows.at(warm=False, interface="qpsolvers", units="natural")
    own, settings = direct.common("label", "setting"), comparison.settings
    lines = []
    for (solver,), part in own.groups("solver").items():
        parts = [part.at(setting=setting) for setting in settings]
        cells = [tenths(float(np.median(p["digits"]))) if p else "-" for p in parts]
        lines.append((solver, *cells))
    return table_text(("solver", *settings), sorted(lines), 1)


def _cvxpy(comparison: Comparison) -> str:
    """Least and largest difference of medians at 1e-9, and the shares at the solvers' own."""
    cold, costs, shares = comparison.rows.at(warm=False, units="natural"), [], []
    for (solver, setting), part in cold.groups("solver", "setting").items():
        own = part.common("interface")
        here, there = (own.at(interface=name) for name in ("qpsolvers", "cvxpy"))
        if not here or not there:
            continue
        if setting == "high":
            costs.append(np.median(there["seconds"]) - np.median(here["seconds"]))
        if setting == "default":
            pair = [tenths(success(p["digits"], 6.0)) for p in (here, there)]
            shares.append(f"{solver} {pair[0]} and {pair[1]}")
    if not costs:
        return ""
    return (
        f"At 1e-9 a call through CVXPY takes {milliseconds(min(costs))} to "
        f"{milliseconds(max(costs))} ms longer than a direct call (medians, solver by solver). "
        f"Share of problems with 6 digits at the solvers' own settings, directly "
        f"and through CVXPY [%]: {', '.join(sorted(shares))}."
    )


def table_text(names: tuple[str, ...], lines: list[tuple[str, ...]], left: int) -> str:
    """A table in Markdown without its title, the first columns text."""
    table = Table("-", "", names, tuple(lines), left)
    return markdown_page(Report("", (Section("", (table,)),))).partition("**-**")[2].strip()


def _trust(first: Rows, rows: list[dict], study: dict) -> Iterator[str]:
    spent: dict[str, float] = {}
    for row in rows:
        label, seconds = f"{row['interface']}:{row['solver']}", row["seconds"]
        spent[label] = spent.get(label, 0.0) + (seconds["spent"] or 0.0)
    most = max(spent, key=lambda label: spent[label])
    late = int((first["outcome"] == "timeout").sum())
    cut = int((first["outcome"] == "not_run_budget").sum())
    yield f"The calls of all solvers took {sum(spent.values()):,.0f} s;"
    yield f"{most} took the most, {spent[most]:.0f} s of its budget of {study['budget']:g} s."
    yield f"The time limit of {study['time_limit']:g} s ended {late:,} calls,"
    yield f"and {cut:,} calls were not made because a budget was used up."
    yield f"The processor was {study['machine'].get('processor', UNKNOWN)}."
