"""Options of solvers searched as their authors would: ``python -m validation.make.option_search``.

For each solver of ``option_search.toml`` the search is on one half of 200 problems (split by run);
its best setting and the solver's defaults are judged on the other. The single changes that the
documentation names are measured on all problems. Every setting that was tried is a line of
``validation/results/option_search.jsonl``; what the log says is written next to it. The times are
of this machine; the digits are not. The log is written after each solver: ``--missing`` goes on
with those that it does not have.
"""

import argparse
import json
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from quasistatic_ref.formats.files import json_text, text_written
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.study.measuring.tuning import (
    Options,
    Score,
    halves,
    line,
    scored,
    searched,
)
from quasistatic_ref.lab.study.problems.for_study import TestSet, study_problems
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.report.words import milliseconds, options_words
from validation.make.option_report import Spaces, is_searched, report

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
        found = scored(solver, options, problems, space.get("function", ""))
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
    text_written(out, "".join(json_text(one) + "\n" for one in log))
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
    old = out.read_text("utf-8").splitlines() if out.exists() else []
    kept = [one for one in map(json.loads, old) if one["solver"] in spaces]
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
