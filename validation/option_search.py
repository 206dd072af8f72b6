"""Options of solvers searched as their authors would: ``python -m validation.option_search``.

For each solver of ``option_search.toml`` the search is on one half of 200 problems (split by run);
its best setting and the solver's defaults are judged on the other. The single changes that the
documentation tells are measured on all problems. Every setting that was tried is a line of
``validation/results/option_search.jsonl``. The times are of this machine; the digits are not.
"""

import argparse
import json
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from quasistatic_ref.files import json_text, text_written
from quasistatic_ref.lab.study.problems import problem_set
from quasistatic_ref.lab.study.qp import Problem
from quasistatic_ref.lab.study.spec import FAMILIES, TestSet
from quasistatic_ref.lab.study.tuning import halves, line, scored, searched
from quasistatic_ref.resources import scenario_names

HERE = Path(__file__).parent
SPACE, RESULTS = HERE / "option_search.toml", HERE / "results" / "option_search.jsonl"
COUNTS = {"scenarios": 100, "contacts": 30, "mass_ratio": 40, "time_step": 20, "bodies": 10}


def problems(folder: str) -> list[Problem]:
    """The 200 problems, made in a folder or read from there."""
    families = dict.fromkeys(FAMILIES, 0) | COUNTS
    return problem_set(TestSet(1, families, tuple(scenario_names())), folder)


def lines(solver: str, space: dict[str, Any], every: Sequence[Problem]) -> Iterator[dict[str, Any]]:
    """The log of one solver."""
    training, judging = halves(every)
    function = space.get("function", "")
    tried = searched(
        space["start"], space["options"], lambda o: scored(solver, o, training, function)
    )
    yield from (line(solver, "training", *one) for one in tried)
    best, _ = min(tried, key=lambda one: one[1].time_to_6)
    for options in ({}, space["start"], best):
        yield line(solver, "judging", options, scored(solver, options, judging, function))
    for finding in space["findings"]:
        for options in (finding["base"], finding["base"] | finding["change"]):
            yield line(solver, "all", options, scored(solver, options, every, function))


def main(arguments: Sequence[str]) -> None:
    """Search for each solver that is named, or for all."""
    spaces = tomllib.loads(SPACE.read_text("utf-8"))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("solvers", nargs="*", choices=[*spaces, []], help="(all)")
    parser.add_argument("--problems", help="a folder that has the problems, or will have them")
    parser.add_argument("--out", type=Path, default=RESULTS, help="the log")
    options = parser.parse_args(arguments)
    asked = options.solvers or list(spaces)
    kept = [json.loads(text) for text in options.out.read_text("utf-8").splitlines()] if (
        options.out.exists()
    ) else []  # fmt: skip
    with tempfile.TemporaryDirectory() as temporary:
        every = problems(options.problems or temporary)
        for solver in asked:
            kept = [one for one in kept if one["solver"] != solver]
            kept += lines(solver, spaces[solver], every)
            kept.sort(key=lambda one: list(spaces).index(one["solver"]))
            text_written(options.out, "".join(json_text(one) + "\n" for one in kept))
            print(f"{solver}: wrote {options.out}")


if __name__ == "__main__":
    main(sys.argv[1:])
