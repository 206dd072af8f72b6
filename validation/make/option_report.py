"""What the log of searched options says, solver by solver, as docs/solver_study.md shows it.

``report(spaces, log)`` is the text; :mod:`validation.make.option_search` writes it next to the log,
from which every number and every option in it is taken. A solver appears once the log has its
search.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from quasistatic_ref.lab.study.report.words import milliseconds, options_words, tenths
from validation.make.study_advice import table_text

Line = dict[str, Any]
Log = Sequence[Line]
Spaces = Mapping[str, Mapping[str, Any]]
SETTINGS = ("its defaults", "start of the search", "best found")
"""What is judged, in this order."""


def of(log: Log, solver: str, half: str) -> list[Line]:
    """The lines of one solver on one half: training, judging, or all."""
    return [one for one in log if (one["solver"], one["half"]) == (solver, half)]


def is_searched(log: Log, solver: str) -> bool:
    """Whether the search of a solver ended: it is judged last."""
    return len(of(log, solver, "judging")) == len(SETTINGS)


def report(spaces: Spaces, log: Log) -> str:
    """The text, in Markdown.

    Parameters
    ----------
    spaces : mapping
        Of `option_search.toml`.
    log : sequence of dict
    """
    done = [solver for solver in spaces if is_searched(log, solver)]
    left = [solver for solver in spaces if solver not in done]
    parts = [
        "Judged on the half that was not searched on:",
        _judged(done, log),
        *_repeated(done, log),
        "What to set, and what it changes:",
        "\n".join(_bullet(solver, log) for solver in done),
        "Single changes, measured on all problems:",
        _findings(spaces, log),
    ]
    if left:
        parts.append(f"Options are listed, but not searched yet, of: {', '.join(left)}.")
    return "\n\n".join(parts) + "\n"


def _judged(solvers: Sequence[str], log: Log) -> str:
    lines = [
        (solver, setting, *map(tenths, (one["six"], one["nine"])), tenths(one["median"]),
         str(one["false_optimal"]), str(one["false_infeasible"]), milliseconds(one["time_to_6"]))
        for solver in solvers
        for setting, one in zip(SETTINGS, of(log, solver, "judging"), strict=True)
    ]  # fmt: skip
    names = (
        "solver", "setting", ">= 6 digits [%]", ">= 9 digits [%]", "digits, median",
        "said optimal, was wrong", "said infeasible, was wrong", "time to 6 digits, mean [ms]",
    )  # fmt: skip
    return table_text(names, lines, 2)


def _repeated(solvers: Sequence[str], log: Log) -> Iterator[str]:
    """How much the times of equal settings differ, if some were judged twice."""
    times = [
        sorted((one["time_to_6"], other["time_to_6"]))
        for solver in solvers
        for one, other in combinations(of(log, solver, "judging"), 2)
        if one["options"] == other["options"]
    ]
    if times:
        most = 100 * max(high / low - 1 for low, high in times)
        yield f"Mean times of equal settings, judged twice, differ by up to {most:.0f} %."


def _bullet(solver: str, log: Log) -> str:
    """What to set; what that delivers, and what the defaults do; which changes alone do what."""
    plain, start, best = of(log, solver, "judging")
    words = (
        f"- **{solver}** at `{options_words(best['options'])}` delivers 6 digits on "
        f"{tenths(best['six'])} % and 9 digits on {tenths(best['nine'])} % of "
        f"{best['problems']} problems, at its defaults on {tenths(plain['six'])} % and "
        f"{tenths(plain['nine'])} %."
    )
    first, *others = of(log, solver, "training")
    alone = [one for one in others if len(_change(first, one)) == 1]
    if best["options"] == start["options"]:
        words += " This is the start: nothing that was tried has 6 digits sooner."
    else:
        least = min(alone, key=lambda one: one["time_to_6"])
        words += (
            f" Of single changes of the start `{options_words(_change(first, least))}` has 6 "
            f"digits soonest: mean {milliseconds(least['time_to_6'])} ms, the start "
            f"{milliseconds(first['time_to_6'])} ms."
        )
    most = max((first, *alone), key=lambda one: one["nine"])
    if most is not first:
        words += (
            f" 9 digits are most frequent with `{options_words(_change(first, most))}`: on "
            f"{tenths(most['nine'])} % of the problems searched on, with the start on "
            f"{tenths(first['nine'])} %."
        )
    return words


def _change(start: Line, one: Line) -> dict[str, Any]:
    """The options of a line that the start does not have."""
    return {k: v for k, v in one["options"].items() if start["options"].get(k) != v}


def _findings(spaces: Spaces, log: Log) -> str:
    names = (
        "solver", "from", "change", ">= 6 digits [%]", ">= 9 digits [%]", "digits, median",
        "said infeasible, was wrong",
    )  # fmt: skip
    lines = [
        (solver, "its defaults" if not finding["base"] else "start of the search",
         f"`{options_words(finding['change'])}`", *_cells(*pair))
        for solver, space in spaces.items()
        for finding in space["findings"]
        for pair in _measured(of(log, solver, "all"), finding)
    ]  # fmt: skip
    return table_text(names, lines, 3)


def _measured(every: Log, finding: Mapping[str, Any]) -> Iterator[tuple[Line, Line]]:
    """The lines before and after a change, if the log has them."""
    base, changed = finding["base"], finding["base"] | finding["change"]
    own = {repr(sorted(one["options"].items())): one for one in every}
    pair = [own.get(repr(sorted(options.items()))) for options in (base, changed)]
    if pair[0] is not None and pair[1] is not None:
        yield pair[0], pair[1]


def _cells(before: Line, after: Line) -> Iterator[str]:
    for name in ("six", "nine", "median"):
        yield f"{tenths(before[name])} to {tenths(after[name])}"
    yield f"{before['false_infeasible']} to {after['false_infeasible']}"
