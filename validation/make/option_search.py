"""Options of solvers searched as their authors would: ``python -m validation.make.option_search``.

For each solver of ``option_search.toml`` the search is on one half of 200 problems (split by run);
its best setting and the solver's defaults are judged on the other. The single changes that the
documentation names are measured on all problems. Every setting that was tried is a line of
``validation/results/option_search.jsonl``; what the log says is written next to it. The times are
of this machine; the digits are not. The log is written after each solver: ``--missing`` goes on
with those that it does not have.
"""

import argparse
import sys
import tempfile
import tomllib
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab import parallel
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.measuring.grade import NOT_RUN, ungraded
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import Limits, measured
from quasistatic_ref.lab.study.problems.for_study import TestSet, study_problems
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.report.rows import rows_of
from quasistatic_ref.lab.study.report.statistics import shifted_geometric_mean, success
from quasistatic_ref.lab.study.report.words import milliseconds, options_words
from validation.make.option_report import Spaces, is_searched, report

Options = dict[str, Any]
MOST_SETTINGS = 40
"""Settings that a solver's search may try..."""
MOST_SECONDS = 1200.0
"""...and what it may take [s]."""
PATIENCE = 1.5
"""What one setting may take, for each problem that it is scored on [s]: most take 0.1 s, one in
which a solver hangs 6 s. A setting in which it hangs again and again would outlast the search."""
WANTED = 6.0
"""Digits that the time is given for."""
LIMITS = Limits(0.5, 5.0, 1)
"""A call that takes longer does not deliver: of the problems here most take 1 ms."""
SEARCHED = Setting("searched", None, 3.0)
AGAIN = ("time_step/bunny_grasp", "closest_points/bunny_grasp", "bunny_grasp/")
"""Beginnings of the names of problems that come from one run."""


@dataclass(frozen=True)
class Score:
    """A setting on some problems.

    Parameters
    ----------
    problems : int
    time_to_6 : float
        Shifted geometric mean, the time limit where six digits were not delivered [s].
    six, nine : float
        Share of problems with so many digits [%].
    median : float
        Of the digits delivered [-].
    solved : int
    false_optimal, false_infeasible : int
        Claims.
    """

    problems: int
    time_to_6: float
    six: float
    nine: float
    median: float
    solved: int
    false_optimal: int
    false_infeasible: int


def halves(problems: Iterable[Problem]) -> tuple[list[Problem], list[Problem]]:
    """Problems to search on and to judge on, no run in both."""
    parts: tuple[list[Problem], list[Problem]] = ([], [])
    for problem in problems:
        parts[zlib.crc32(run_of(problem.id).encode()) % 2].append(problem)
    return parts


def run_of(name: str) -> str:
    """The run that a problem is of: its scenario, or itself where it was made alone."""
    name = name.removeprefix("scenarios/")
    if name.startswith(AGAIN):
        return AGAIN[-1]
    family, _, rest = name.partition("/")
    return name if "/" in rest else family


def scored(
    solver: str, options: Options, problems: Sequence[Problem], interface: str = "qpsolvers"
) -> Score:
    """A solver in natural units, cold, with these options.

    Problems that `PATIENCE` does not reach count as those that time out.

    Parameters
    ----------
    solver : str
    options : dict
        In its own names.
    problems : sequence of Problem
    interface : str
        One that takes them all.
    """
    one = Solver(solver, interface, solver, {SEARCHED.name: options})
    names = {"family": "", "solver": solver, "interface": interface, "setting": SEARCHED.name,
             "mode": "", "units": "natural", "warm": False, "repetition": 0}  # fmt: skip
    late = perf_counter() + PATIENCE * len(problems)
    rows = []
    with Keeper(one) as keeper:
        for p in problems:
            if perf_counter() < late:
                row = measured(keeper, p, SEARCHED, "natural", False, LIMITS)
            else:
                row = ungraded(NOT_RUN, "not run (patience)", None, p.feasible)
            rows.append(names | {"problem": p.id} | row)
    found = rows_of(rows, LIMITS.call)
    times = np.where(found["digits"] >= WANTED, found["seconds"], LIMITS.call)
    false = [found["wrong"] & found[f"said_{claim}"] for claim in ("optimal", "infeasible")]
    return Score(
        problems=len(rows),
        time_to_6=shifted_geometric_mean(times),
        six=success(found["digits"], 6.0),
        nine=success(found["digits"], 9.0),
        median=float(np.median(found["digits"])),
        solved=int(found["solved"].sum()),
        false_optimal=int(false[0].sum()),
        false_infeasible=int(false[1].sum()),
    )


def searched(
    start: Options,
    values: Mapping[str, Sequence[Any]],
    score: Callable[[Options], Score],
    seconds: float = MOST_SECONDS,
) -> list[tuple[Options, Score]]:
    """The settings that were tried, in order; the best of them is to be used.

    Parameters
    ----------
    start : dict
        The options that it starts from.
    values : mapping of str to sequence
        What the manual lets each option be, and is worth trying.
    score : callable
        Of options, on the training half.
    seconds : float
        After which no more are tried [s].
    """
    begin, tried = perf_counter(), [(start, score(start))]

    def tries(options: Options) -> Score | None:
        late = perf_counter() - begin > seconds or len(tried) >= MOST_SETTINGS
        if late or any(options == old for old, _ in tried):
            return None
        tried.append((options, score(options)))
        return tried[-1][1]

    gains: list[tuple[float, Options]] = []
    for name, choices in values.items():
        for choice in choices:
            if found := tries(start | {name: choice}):
                gains.append((found.time_to_6, {name: choice}))
    best, least = start, tried[0][1].time_to_6
    for _, change in sorted(gains, key=lambda gain: gain[0]):
        found = tries(best | change)
        here = found or next((s for o, s in tried if o == best | change), None)
        if here is not None and here.time_to_6 < least:
            best, least = best | change, here.time_to_6
    return tried


def line(solver: str, half: str, options: Options, score: Score) -> dict[str, Any]:
    """One line of a search's log."""
    numbers = {k: round(v, 6) if isinstance(v, float) else v for k, v in asdict(score).items()}
    return {"solver": solver, "half": half, "options": options, **numbers}


HERE = Path(__file__).parent
SPACE, RESULTS = HERE / "option_search.toml", HERE.parent / "results" / "option_search.jsonl"
COUNTS = {"scenarios": 100, "contacts": 30, "mass_ratio": 40, "time_step": 20, "bodies": 10}


def problems(folder: str) -> list[Problem]:
    """The 200 problems, made in a folder or read from there."""
    return study_problems(TestSet(1, COUNTS, tuple(scenario_names())), folder)


def lines(solver: str, space: dict[str, Any], every: Sequence[Problem]) -> Iterator[dict[str, Any]]:
    """The log of one solver; a setting is printed when it has been tried."""
    training, judging = halves(every)

    def score(half: str, problems: Sequence[Problem], options: Options) -> Score:
        found = scored(solver, options, problems, space.get("interface", "qpsolvers"))
        print(f"{solver}, {half}: {options_words(options)}: {found.six:.0f} % with 6 digits, mean "
              f"time to them {milliseconds(found.time_to_6)} ms", flush=True)  # fmt: skip
        return found

    tried = searched(space["start"], space["options"], lambda o: score("training", training, o))
    yield from (line(solver, "training", *one) for one in tried)
    best, _ = min(tried, key=lambda one: one[1].time_to_6)
    for options in ({}, space["start"], best):
        yield line(solver, "judging", options, score("judging", judging, options))
    for finding in space["findings"]:
        for options in (finding["base"], finding["base"] | finding["change"]):
            yield line(solver, "all", options, score("all", every, options))


def written(out: Path, spaces: Spaces, log: list[dict[str, Any]]) -> None:
    """The log, in the order of the spaces, and next to it what it says."""
    log.sort(key=lambda one: list(spaces).index(one["solver"]))
    text_written(out, parallel.lines(log))
    text_written(out.with_suffix(".md"), report(spaces, log))


def main(arguments: Sequence[str]) -> None:
    """Search for each solver that is named, or for all; one that fails stops no other."""
    spaces = tomllib.loads(SPACE.read_text("utf-8"))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("solvers", nargs="*", choices=[*spaces, []], help="(all)")
    parser.add_argument("--missing", action="store_true", help="only those not in the log yet")
    parser.add_argument("--problems", help="a folder that has the problems, or will have them")
    parser.add_argument("--out", type=Path, default=RESULTS, help="the log")
    options = parser.parse_args(arguments)
    out = options.out
    old = parallel.records_read(out) if out.exists() else []
    kept = [one for one in old if one["solver"] in spaces]
    names = [s for s in options.solvers or spaces if not (options.missing and is_searched(kept, s))]
    failed = []
    with tempfile.TemporaryDirectory() as temporary:
        every = problems(options.problems or temporary)
        for solver in names:
            begin = perf_counter()
            try:
                own = list(lines(solver, spaces[solver], every))
            except Exception as error:  # whatever happens to one solver, the others are searched
                failed.append(solver)
                print(f"{solver}: not searched: {type(error).__name__}: {error}", flush=True)
                continue
            kept = [one for one in kept if one["solver"] != solver] + own
            written(out, spaces, kept)
            minutes = (perf_counter() - begin) / 60
            print(f"{solver}: wrote {out} after {minutes:.1f} minutes", flush=True)
    if failed:
        sys.exit(f"not searched: {', '.join(failed)}; the log has of them what it had before")


if __name__ == "__main__":
    main(sys.argv[1:])
