"""Questions to the rows of the committed study, which the documentation quotes the answers of."""

import json
from functools import cache
from pathlib import Path

import numpy as np

from quasistatic_ref.lab.study.columns import chosen, columns_of, common, groups, size
from quasistatic_ref.lab.study.page import digits, milliseconds, percent
from quasistatic_ref.lab.study.statistics import success
from quasistatic_ref.lab.study.store import rows_read, study_read

DEFAULT = Path(__file__).parents[2] / "validation" / "studies" / "default"
FIELDS = ("label", "solver", "interface", "setting", "units", "warm", "unit", "family", "problem",
          "solved", "asked", "said_optimal", "said_infeasible", "outcome", "digits", "seconds",
          "iterations")  # fmt: skip
WIDEST = {"interface": "qpsolvers", "units": "natural", "warm": False}
SETTINGS = ("default", "low", "mid", "high", "tuned")
CVXPY = ("clarabel", "daqp", "highs", "osqp", "piqp", "proxqp", "qpalm", "scs")
GIVEN = ("high", "tuned")
"""Settings at which options are given, of those that were asked through CVXPY."""
CHANGE = 0.5
"""Digits that the page calls a change."""


@cache
def study():
    return study_read(DEFAULT)


@cache
def columns():
    """The rows as the report has them, and what each took with starts, warm-ups and kills [s].

    ``wrong`` is of claims of success here, ``false_infeasible`` of claims that there is none.
    """
    rows = rows_read(DEFAULT)
    every = columns_of(rows, study()["time_limit"])
    spent = np.array([row["seconds"]["spent"] or 0.0 for row in rows])
    kept = {name: every[name] for name in FIELDS} | {"spent": spent}
    said = {name: every["wrong"] & every[f"said_{name}"] for name in ("optimal", "infeasible")}
    return kept | {"wrong": said["optimal"], "false_infeasible": said["infeasible"]}


@cache
def enclosed():
    """How many problems have an answer that is enclosed and not exact."""
    lines = (DEFAULT / "problems.jsonl").read_text().splitlines()
    return sum(json.loads(line)["kind"] == "enclosure" for line in lines)


@cache
def of_solver(solver):
    return chosen(columns(), {"solver": solver})


@cache
def directly(units="natural"):
    """What was asked directly and cold."""
    return chosen(columns(), WIDEST | {"units": units})


@cache
def asked(solver, setting):
    """A solver at a setting, on all problems."""
    return chosen(directly(), {"solver": solver, "setting": setting})


@cache
def every_setting(units):
    return common(directly(units), ["label", "setting"])


@cache
def shared(solver, setting, units="natural"):
    """A solver at a setting, on the problems that all were asked on at every setting."""
    return chosen(every_setting(units), {"solver": solver, "setting": setting})


@cache
def both(solver, setting, name, values, base=()):
    """Two parts that differ in one field, on the problems that both have, in one order."""
    part = common(chosen(of_solver(solver), {"setting": setting, **dict(base)}), [name])
    return [ordered(chosen(part, {name: value})) for value in values]


def ordered(part):
    order = np.argsort(part["unit"])
    return {name: column[order] for name, column in part.items()}


def by_interface(solver, setting):
    cold = (("units", "natural"), ("warm", False))
    return both(solver, setting, "interface", ("qpsolvers", "cvxpy"), cold)


def by_start(solver, setting):
    direct = (("units", "natural"), ("interface", "qpsolvers"))
    return both(solver, setting, "warm", (False, True), direct)


def share(part, least=6.0):
    return percent(success(part["digits"], least))


def median(part):
    return digits(float(np.median(part["digits"])))


def time(part):
    return milliseconds(float(np.median(part["seconds"])))


def false_share(solver):
    """False claims of those of success, at the solver's own setting, a whole number [%]."""
    part = asked(solver, "default")
    return f"{100 * part['wrong'].sum() / part['said_optimal'].sum():.0f}"


def unsolved(part):
    return percent(100 * float(np.mean(~part["solved"])))


def missed(solver, *families, begins=""):
    """Problems without 6 digits at 1e-9: how many of these families, and how many in all."""
    part = asked(solver, "high")
    bad = {name: column[part["digits"] < 6.0] for name, column in part.items()}
    own = np.isin(bad["family"], families)
    own |= np.char.startswith(bad["problem"], begins) if begins else False
    return int(own.sum()), size(bad)


def spent():
    """Seconds that each solver took, by interface:solver."""
    return {label: float(own["spent"].sum()) for (label,), own in groups(columns(), ["label"])}


def raw_and_natural(solver, setting):
    return [share(shared(solver, setting, units)) for units in ("raw", "natural")]


def median_raw_and_natural(solver):
    return [median(shared(solver, "tuned", units)) for units in ("raw", "natural")]


def overhead():
    """Least and largest difference of the medians of both ways to a solver [ms]."""
    found = [
        1e3 * float(np.median(there["seconds"]) - np.median(here["seconds"]))
        for here, there in (by_interface(s, setting) for s in CVXPY for setting in GIVEN)
    ]
    return min(found), max(found)


def shares_by_interface(solver, setting):
    return [share(part) for part in by_interface(solver, setting)]


def other_shares():
    """Whose share with 6 digits is another through CVXPY, where options are given."""
    pairs = {(s, setting): shares_by_interface(s, setting) for s in CVXPY for setting in GIVEN}
    return [name for name, (here, there) in pairs.items() if here != there]


def other_digits():
    """Of how many problems CVXPY changes the digits, where options are given."""
    found = {}
    for name in ((s, setting) for s in CVXPY for setting in GIVEN):
        here, there = by_interface(*name)
        if changed := int((abs(here["digits"] - there["digits"]) > CHANGE).sum()):
            found[name] = changed, size(here)
    return found


def warm_iterations(solver):
    """Median iterations from a cold and a warm start, by setting."""
    parts = {setting: by_start(solver, setting) for setting in SETTINGS}
    return {s: [float(np.median(p["iterations"])) for p in pair] for s, pair in parts.items()}
