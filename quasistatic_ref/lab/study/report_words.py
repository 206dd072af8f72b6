"""The sentences of a report: method, limitations, where it ran."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.study.page import Table
from quasistatic_ref.lab.study.statistics import SHIFT

METHOD = (
    "Each problem is `min 1/2 x'Hx - g'x, Ax >= b`, one step of a contact simulation. Its exact "
    "answer is known; beyond 60 coordinates it is enclosed, and no digit beyond the bound is told.",
    "Digits are -log10 of `||x - x*||_H / ||H^-1 g||_H`, 0 to 16. In this report a solver delivers "
    "the digits of its answer if it says that it solved the problem (outcome solved), otherwise 0, "
    "since a simulator cannot go on with the answer of a solver that failed.",
    "A claim is false (said optimal, was wrong) if the solver says optimal and its answer has "
    "fewer digits than the setting promises. By strong convexity `||x - x*||_H^2 <= 2 gap`, so an "
    "accuracy promises about half of its digits.",
    "A time is that of the whole call, conversions on the road included, compilation by CVXPY not; "
    "a call that did not solve counts with the time limit of {limit:g} s. Times are compared "
    "within this run only, on the same problems: all solvers are asked on a problem before the "
    "next one, the first place going round. They are summed up by medians and by the shifted "
    f"geometric mean `exp(mean(log(t + s))) - s`, s = {1e3 * SHIFT:g} ms.",
    "Performance profiles are after Dolan and More (Math. Program. 91, 2002): the share of "
    "problems that a solver gets right, to the digits named, within tau times the time of the "
    "fastest solver that does. At the left end: how often it is the fastest; at the right end: "
    "how often it is right.",
    "Each table and figure names its rows: those of `rows.jsonl` whose fields have these values. "
    "Its first columns narrow them down to the rows of one number; `solver` is road:solver.",
)

LIMITATIONS = (
    "The problems are steps of this package's own scenarios and families: small (most have fewer "
    "than 25 coordinates), dense, strictly convex, with linear inequalities only. Nothing here is "
    "about large sparse programs.",
    "The matrices are rounded to float64 before anybody sees them, and the answer is that to the "
    "rounded ones.",
    "Calls are made from Python. For calls of microseconds the road takes longer than the solver; "
    "`seconds.solver` of a row is the solver's own account, where it gives one.",
    "The settings of a solver are asked in a fixed order, and its first call on a problem finds "
    "cold caches, which costs some hundredths of a millisecond: times of different solvers at one "
    "setting can be compared, those of one solver at different settings only beyond that.",
    "Steps of one run resemble each other, so the number of problems overstates how much was seen. "
    "A profile shows who is near the fastest; the order of the others can change when the "
    "fastest is left out (Gould and Scott, ACM TOMS 43, 2016).",
    "Settings are plain readings of the manuals, the setting tuned aside; someone who knows a "
    "solver well will do better. Times are those of one machine.",
)


def method(limit: float) -> tuple[str, ...]:
    """How everything was measured, with the time limit of a problem [s]."""
    return tuple(words.replace("{limit:g}", f"{limit:g}") for words in METHOD)


def place_tables(study: Mapping[str, Any]) -> tuple[Table, Table]:
    """Machine and versions."""
    machine = tuple((str(k), str(v)) for k, v in study["machine"].items())
    packages = tuple((str(k), str(v)) for k, v in study["versions"].items())
    return (
        Table("Machine.", "study.json, machine", ("what", "which"), machine, left=2),
        Table("Versions.", "study.json, versions", ("package", "version"), packages, left=2),
    )


def settings_table(settings: Sequence[Mapping[str, Any]]) -> Table:
    """What the settings ask for and promise."""
    rows = tuple(
        (s["name"], "its own" if s["accuracy"] is None else f"{s['accuracy']:g}",
         f"{s['promised']:g}", "the simulator's" if s["tuned"] else "plain")
        for s in settings
    )  # fmt: skip
    names = ("setting", "accuracy", "digits promised", "options")
    return Table("The settings.", "study.json, settings", names, rows)
