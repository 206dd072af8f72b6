"""The tables of a report on solvers; each carries the filter that gives its rows."""

import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.certify.norm import digits_of_error
from quasistatic_ref.lab.page.parts import Block, Table
from quasistatic_ref.lab.study.calling.claims import HIDDEN, claim
from quasistatic_ref.lab.study.calling.sessions import COLD
from quasistatic_ref.lab.study.report.cheats import cheat_alone, cheat_in_order
from quasistatic_ref.lab.study.report.comparison import WANTED, Comparison, Soonest
from quasistatic_ref.lab.study.report.rows import Rows, Where
from quasistatic_ref.lab.study.report.statistics import (
    LOW,
    SHIFT,
    interval,
    resampled_means,
    shifted_geometric_mean,
    success,
)
from quasistatic_ref.lab.study.report.words import (
    filter_words,
    milliseconds,
    options_words,
    tenths,
)
from quasistatic_ref.lab.study.store.rows import NAN, NOT_RUN, OUTCOMES, SOLVED, Row
from quasistatic_ref.solve.backends import BACKENDS

LEVELS = (3.0, 6.0, 9.0)
"""Digits at which success is counted."""
LIMITS = tuple({b.time_limit for b in BACKENDS.values()})
"""Options that are not advice."""
WORST_SHOWN = 10
"""How many worst problems of a solver are shown."""
HALF = "half = 1, or all where a half is empty; calls that a budget did not reach left out"
ALL = "from the first column of claims on, of all problems"
KEPT: Where = {"outcome": "solved", "feasible": True, "wrong": False}
SHARED = "; on the {} on which all these solvers were called"
WAY = ("interface", "solver", "claimed")
Cell = Callable[[Rows], str]
Mask = Callable[[Rows], Any]
"""Rows -> which of them."""


def _share(least: float) -> Cell:
    return lambda rows: tenths(success(rows["digits"], least))


def _median(name: str, words: Callable[[float], str]) -> Cell:
    return lambda rows: words(float(np.median(rows[name])))


def _count(mask: Mask) -> Cell:
    return lambda rows: str(int(mask(rows).sum()))


def _rows_alone(rows: Rows) -> Any:
    """Claims of success that are false by violated rows alone, or by digits that were promised."""
    others = rows["wrong_multipliers"] | (rows["outcome"] == NAN)
    return rows["wrong"] & rows["said_optimal"] & rows["feasible"] & ~others


def _percentile(name: str, share: float, words: Callable[[float], str]) -> Cell:
    """A percentile of what is known of a field, over the calls that solved their problem."""

    def cell(rows: Rows) -> str:
        values = rows.at(solved=True)[name]
        known = values[np.isfinite(values)]
        return words(float(np.percentile(known, share))) if len(known) else "-"

    return cell


CELLS: dict[str, Cell] = {
    "calls": lambda rows: str(len(rows)),
    "solved [%]": lambda rows: tenths(100 * float(rows["solved"].mean())),
    **{f">= {d:g} digits [%]": _share(d) for d in LEVELS},
    "digits, 1st percentile": lambda rows: tenths(float(np.percentile(rows["digits"], LOW))),
    "digits, median": _median("digits", tenths),
    "digits of the net wrench, median": _median("net", tenths),
    "time, median [ms]": _median("seconds", milliseconds),
    "time, shifted geometric mean [ms]": lambda rows: milliseconds(
        shifted_geometric_mean(rows["seconds"])
    ),
}
"""The columns of a table of one setting: heading -> what stands there, of one solver's rows."""
CLAIMS: dict[str, Cell] = {
    "false: rows": _count(_rows_alone),
    "false: multipliers": _count(lambda r: r["wrong_multipliers"] & r["feasible"]),
    "false: no numbers": _count(
        lambda r: r["said_optimal"] & r["feasible"] & (r["outcome"] == NAN)
    ),
    "false: no solution exists": _count(lambda r: r["said_optimal"] & r["wrong"] & ~r["feasible"]),
    "kept, no solution exists": _count(lambda r: r["said_optimal"] & ~r["wrong"] & ~r["feasible"]),
    "false: infeasible": _count(lambda r: r["said_infeasible"] & r["wrong"]),
}
"""Claims by kind: of success, on problems with a solution (the first three) and without one (the
next two: beyond the tolerances, and within them), and that there is none."""


def solver_table(comparison: Comparison, setting: str) -> Table:
    """Every solver at one setting: digits, success and time, of the calls that were made."""
    where = comparison.at(setting)
    own = comparison.calls.at(setting=setting)
    heads = solver_headings(comparison.rows)
    rows = [
        (*solver_cells(part), *(cell(part) for cell in CELLS.values()))
        for part in own.groups("label").values()
    ]
    title = f"Setting {setting}, {where['units']} units."
    words = filter_words(where, "; calls that a budget did not reach left out")
    return Table(title, words, (*heads, *CELLS), tuple(rows), left=len(heads))


def solver_headings(rows: Rows) -> tuple[str, ...]:
    """The first columns of tables on solvers: the machine is one where several were merged."""
    return ("solver", "interface", *(("machine",) if any(rows["machine"]) else ()))


def solver_cells(part: Rows) -> list[str]:
    """What stands in these columns, of rows of one solver."""
    return [part.first(name) for name in solver_headings(part)]


def same_problems(rows: Rows) -> str:
    """How many problems a comparison is on, as the end of a filter."""
    return SHARED.format(f"{len(set(rows['unit'])):,} problems")


def _shares(own: Rows) -> str:
    """The share with 6 digits, and its interval."""
    samples = resampled_means((own["digits"] >= WANTED).astype(float), own["family"])
    span = " to ".join(map(tenths, interval(100 * samples)))
    return f"{_share(WANTED)(own)} ({span})"


SCREEN: dict[str, Cell] = {
    f">= {WANTED:g} digits [%] (95 % of bootstraps)": _shares,
    ">= 3 digits [%]": _share(3.0),
    "digits of A'lam, median": _percentile("net", 50, tenths),
    "time, median [ms]": _percentile("seconds", 50, milliseconds),
    "time, 95 % [ms]": _percentile("seconds", 95, milliseconds),
    "repeated call, median [ms]": _percentile("call", 50, milliseconds),
}
"""What the first table has of the half on which a solver is judged."""
OTHERS = ("failures", "calls not made", "looks as if it")
"""What it has of all problems, besides claims."""


def headline(found: Sequence[Soonest], comparison: Comparison) -> Table:
    """Every solver in one row: digits, times, false claims by kind, and what it looks like."""
    heads = solver_headings(comparison.rows)
    lines = [(*solver_cells(one.rows), *_screen_cells(one, comparison)) for one in found]
    there = {one.rows.first("solver") for one in found}
    absent = sorted({str(one["name"]) for one in comparison.study["solvers"]} - there)
    blank = ["-"] * (len(SCREEN) + len(CLAIMS) + len(OTHERS) + len(heads) - 2)
    lines += [(name, "never called", *blank) for name in absent]
    title = f"Each solver at the setting that has {WANTED:g} digits soonest on the other half."
    where = filter_words(comparison.base, f"; {HALF}; {ALL}")
    return Table(title, where, (*heads, *SCREEN, *CLAIMS, *OTHERS), tuple(lines), len(heads))


def _screen_cells(one: Soonest, comparison: Comparison) -> list[str]:
    every = comparison.every_call(one)
    failed = len(every.at(feasible=True, said_optimal=False))
    cells = [cell(one.rows) for cell in SCREEN.values()]
    cells += [cell(every) for cell in CLAIMS.values()]
    return [*cells, str(failed), str(one.missing), cheat_alone(every.at(feasible=True)) or "-"]


def interface_table(comparison: Comparison) -> Table:
    """Every interface to a solver at its setting, with its options, and all that is known of it."""
    found = comparison.soonest
    names = (*solver_headings(comparison.rows), "setting", "its own options")
    lines = []
    for one in found:
        own = one.rows
        span = interval(np.exp(resampled_means(np.log(one.times + SHIFT), own["family"])) - SHIFT)
        given = options_words(comparison.options[own.first("way")][one.setting], LIMITS)
        lines.append((
            *solver_cells(own), one.setting, f"`{given}`", str(len(own)),
            *_screen_cells(one, comparison), milliseconds(one.mean),
            " to ".join(map(milliseconds, span)), _tie(one, found, comparison),
        ))  # fmt: skip
    columns = (
        *names, "problems", *SCREEN, *CLAIMS, *OTHERS,
        f"time to {WANTED:g} digits, shifted geometric mean [ms]", "95 % of bootstraps, mean",
        "tie with the first",
    )  # fmt: skip
    title = (
        f"Every interface to a solver at the setting that has {WANTED:g} digits soonest on the "
        "other half."
    )
    where = filter_words(comparison.base, f"; {HALF}; {ALL}")
    return Table(title, where, columns, tuple(lines), len(names))


def _tie(one: Soonest, found: Sequence[Soonest], comparison: Comparison) -> str:
    """Whether a solver is as fast as the first of its machine, as far as times are known."""
    first = next(other for other in found if other.machine == one.machine)
    floor = comparison.noise.floor
    if one is first or comparison.busy:
        return "-"
    if floor is None:
        return "not known"
    return "yes" if one.mean <= first.mean * (1 + floor) else "no"


def outcome_table(rows: Rows) -> Table:
    """How all calls ended, solver by solver."""
    lines = []
    for (label,), part in rows.groups("label").items():
        ends = part["outcome"]
        lines.append((label, str(len(part)), *(str(int((ends == o).sum())) for o in OUTCOMES)))
    names = ("not run (budget)" if o == NOT_RUN else o.replace("_", " ") for o in OUTCOMES)
    head = ("solver", "calls", *names)
    return Table("How the calls ended.", "repetition = 0", head, tuple(lines))


def claims_sentences(rows: Rows) -> list[str]:
    """How many claims were made, and are false, on problems with and without a solution."""
    possible = rows.at(feasible=True, said_optimal=True)
    impossible = rows.at(feasible=False, said_optimal=True)
    none = rows.at(said_infeasible=True)
    by_multipliers = len(possible.at(wrong=True, wrong_multipliers=True))
    false = len(possible.at(wrong=True))
    beyond = len(impossible.at(wrong=True))
    kept = len(rows.at(said_optimal=True, wrong=True).kept(is_within_limits))
    return [
        f"Of {len(possible):,} claims of success on problems with a solution {false:,} are false: "
        f"in {by_multipliers:,} the dual residual or the gap is larger than promised, in the other "
        f"{false - by_multipliers:,} only the violation of rows, or there are no numbers.",
        f"On problems without a solution success was claimed {len(impossible):,} times: "
        f"{beyond:,} times falsely, and {len(impossible) - beyond:,} times with residuals that "
        "keep their limits, as they can where a problem is nearly feasible.",
        f"Of {len(none):,} claims that there is no solution {len(none.at(wrong=True)):,} are "
        "false.",
        f"{kept:,} of the false claims of success have all of their residuals within the limits.",
    ]


def is_within_limits(row: Row) -> bool:
    """Whether each residual is within its limit, in a row that was judged by residuals."""
    limits = {name: most for name, most in row["allowed"].items() if most is not None}
    judged = row["outcome"] == SOLVED and bool(limits)
    return judged and all((row["residuals"][n] or 0.0) <= most for n, most in limits.items())


def false_claims(rows: Rows, settings: Sequence[str], where: Where) -> Table:
    """The claims by kind, of how many claims of success, setting by setting."""
    lines = []
    for (label,), part in rows.at(where).groups("label").items():
        cells = []
        for setting in settings:
            own = part.at(setting=setting)
            words = " + ".join(cell(own) for cell in CLAIMS.values()) if own else ""
            cells.append(f"{words} / {int(own['said_optimal'].sum())}" if own else "-")
        lines.append((label, *cells))
    way = "warm" if where["warm"] else "cold"
    title = f"Claims, {where['units']} units, {way}: {' + '.join(CLAIMS)} / all of success."
    return Table(title, filter_words(where), ("solver", *settings), tuple(lines))


def detection(rows: Rows) -> Block:
    """What solvers say of problems that have no solution."""
    lines = []
    for key, part in rows.at(feasible=False, called=True).groups("label", "setting").items():
        right = int(part["said_infeasible"].sum())
        success = int(part["said_optimal"].sum())
        hidden = sum(claim(*(row[n] for n in WAY)) == HIDDEN for row in part)
        neither = len(part) - right - success - hidden
        lines.append((*key, *map(str, (len(part), right, success, neither, hidden))))
    if not lines:
        return "The study contains no problem without a solution."
    names = ("solver", "setting", "calls", "infeasible", "success", "neither", "not said")
    title = (
        "What is said of problems that have no solution, as Farkas vectors prove; where an "
        "interface has one word for several exit codes, what the solver said is not known."
    )
    return Table(title, "feasible = false", names, tuple(lines), left=2)


def kept_digits(rows: Rows, settings: Sequence[str]) -> Table:
    """Digits of answers that kept their tolerances: they depend on problem and accuracy."""
    lines = []
    for (family,), part in rows.at(KEPT).groups("family").items():
        cells = [words for s in settings for words in _low_and_median(part.at(setting=s)["digits"])]
        lines.append((family, *cells))
    columns = [f"{setting}, {of}" for setting in settings for of in ("5th percentile", "median")]
    title = "Digits of delta_q of the answers that kept their tolerances, of all solvers."
    return Table(title, filter_words(KEPT), ("family", *columns), tuple(sorted(lines)))


def _low_and_median(digits: np.ndarray) -> tuple[str, str]:
    if not len(digits):
        return "-", "-"
    low, median = np.percentile(digits, [5, 50])
    return tenths(low), tenths(median)


def contrast(
    comparison: Comparison,
    title: str,
    by: str,
    values: Sequence[Any],
    where: Where,
    ways: tuple[str, str] = ("who", "setting"),
    iterations: bool = False,
) -> Table:
    """One field at two or more values, each solver and setting on the same problems.

    Parameters
    ----------
    comparison : Comparison
    title : str
    by : str
        The field.
    values : sequence
    where : mapping
        What is the same.
    ways : tuple of str
        What distinguishes one line from another.
    iterations : bool
        Whether their medians are columns, too.
    """
    shown = {">= 6 digits [%]": CELLS[">= 6 digits [%]"],
             "time, median [ms]": CELLS["time, median [ms]"]}  # fmt: skip
    if iterations:
        shown["iterations, median"] = lambda rows: _median_known(rows["iterations"])
    every = comparison.rows.at(where).groups(*ways)
    solvers = dict.fromkeys(solver for solver, _ in every)
    lines = []
    for key in ((solver, setting) for solver in solvers for setting in comparison.settings):
        own = every[key].common(by) if key in every else Rows(())
        parts = [own.at({by: value}) for value in values]
        if all(parts):
            cells = (cell(part) for cell in shown.values() for part in parts)
            lines.append((*key, str(len(set(own["unit"]))), *cells))
    names = [f"{heading}, {filter_words({by: value})}" for heading in shown for value in values]
    said = f"; each line is on the problems with a call at every value of {by}"
    head = ("solver", "setting", "problems", *names)
    return Table(title, filter_words(where, said), head, tuple(lines), left=2)


def family_table(comparison: Comparison, setting: str) -> Table:
    """Median digits of each solver by family, at one setting."""
    where = comparison.at(setting)
    own = comparison.calls.at(setting=setting)
    labels = [label for (label,) in own.groups("label")]
    lines = []
    for (family,), part in own.groups("family").items():
        known = {label: CELLS["digits, median"](p) for (label,), p in part.groups("label").items()}
        lines.append((family, *(known.get(label, "-") for label in labels)))
    title = f"Median digits by family, setting {setting}."
    return Table(title, filter_words(where), ("family", *labels), tuple(lines))


def worst_problems(
    comparison: Comparison,
    facts: Sequence[Mapping[str, Any]],
    ways: Iterable[Soonest],
    store: str,
) -> list[Block]:
    """What a solver's author looks at first: a table for each, the most digits missed first.

    Parameters
    ----------
    comparison : Comparison
    facts : sequence of mapping
        Of the problems.
    ways : iterable of Soonest
        Solvers, with their interfaces and settings.
    store : str
        The folder of the study, as seen from that of the report.
    """
    words = (
        "Each table is of one solver, at the setting and through the interface that deliver 6 "
        "digits soonest. It lists the calls whose answers miss the most of the known digits; of "
        "calls that miss equally many, the slowest come first. The command runs the solver on the "
        "problem again, with the same options, and prints how wrong the answer is. Run it in "
        "the folder of this page."
    )
    known = {fact["id"]: digits_of_error(fact["bound"]) for fact in facts}

    def missed_and_slow(row: Row) -> tuple[float, float, str]:
        missed = max(known[row["problem"]] - row["digits"], 0.0)
        return -missed, -row["seconds"], row["problem"]

    names = ("problem", "outcome", "its own status", "false claim", "command", "digits",
             "digits known", "time [ms]")  # fmt: skip
    tables = []
    for one in ways:
        where = {**comparison.at(one.setting), "label": one.label}
        worst = sorted(comparison.rows.at(where), key=missed_and_slow)[:WORST_SHOWN]
        lines = tuple(
            (*(row[n] for n in ("problem", "outcome", "claimed")), "yes" if row["wrong"] else "no",
             f"`{ask_command(row, store)}`", tenths(row["digits"]), tenths(known[row["problem"]]),
             milliseconds(row["seconds"]))
            for row in worst
        )  # fmt: skip
        title = f"Worst {WORST_SHOWN} problems of {one.label} at {one.setting}."
        tables.append(Table(title, filter_words(where), names, lines, left=5))
    return [words, *tables]


def ask_command(row: Row, store: str) -> str:
    """The command that repeats one measurement of the study in a folder."""
    words = [row[name] for name in ("problem", "way", "setting")]
    units = [] if row["units"] == "natural" else ["--units", row["units"]]
    start = ["--warm"] if row["warm"] else []
    return shlex.join(["quasistatic-ref", "study", "ask", *words, *units, *start,
                       "--store", store])  # fmt: skip


def sequence_tables(rows: Rows, facts: Sequence[Mapping[str, Any]]) -> list[Block]:
    """A line for each solver, setting and mode, on all steps but the first of each sequence.

    Parameters
    ----------
    rows : Rows
    facts : sequence of mapping
        Of the problems, with their places in sequences.
    """
    later = {fact["id"] for fact in facts if fact["place"]}
    steps = rows.kept(lambda row: bool(row["mode"]) and row["problem"] in later)
    named = []
    lines = []
    for key, modes in steps.groups("label", "setting", "units").items():
        cold = modes.at(mode=COLD)["call"]
        for (mode,), own in modes.groups("mode").items():
            call = _median_or_none(own["call"])
            over = _median_or_none(cold)
            lines.append((
                *key, mode, str(len(own)), str(int(own["solved"].sum())),
                tenths(own["digits"].min()), _median_known(own["iterations"]),
                "-" if call is None else milliseconds(call),
                "-" if call is None or over is None else f"{call / over:.2f}",
            ))  # fmt: skip
            if cheat := cheat_in_order(own):
                named.append(f"{key[0]} ({mode}) looks as if it {cheat}.")
    names = ("solver", "setting", "units", "mode", "problems", "solved", "digits, worst",
             "iterations, median", "time, median [ms]", "over cold")  # fmt: skip
    title = "Steps of sequences, each from what the solver kept of the step before."
    table = Table(title, "mode is given, place > 0", names, tuple(lines), left=4)
    return [*named, table] if lines else []


def _median_or_none(values: np.ndarray) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else None


def _median_known(values: np.ndarray) -> str:
    median = _median_or_none(values)
    return "-" if median is None else f"{median:g}"
