"""Derivatives of random states against differences without rounding.

``python -m validation.make.derivative_states --states 3000``, some twenty minutes on one core.
States of all scenarios, of pushes of every couple of shapes, of every pair of shapes of random
sizes, of bodies with up to 20 contacts and of random mechanisms; of each derivative two random
directions, and on every 29th state all columns besides. With ``--log FILE`` a run can be stopped
and goes on where it was. Exit status 1 if a number is wrong, or stands where there is a kink.
"""

import argparse
import itertools
import sys
from collections import defaultdict
from collections.abc import Iterator
from operator import itemgetter
from pathlib import Path
from typing import Final

import numpy as np

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.parallel import Log, Record
from quasistatic_ref.lab.vectors.layers.derivative import QUIET, STILL
from tests.oracles.gradients.judge import judged
from tests.oracles.gradients.reference import FIELDS
from tests.oracles.gradients.states import state

WITHIN: Final = 1e-9
"""Largest difference that is promised, relative to the largest entry of the same derivative."""
EVERY: Final = 29
"""Of this many states one has all columns compared."""
MODES: Final = ("sticking", "sliding", "spinning", "lifting", "separated")
COUNTS: Final = ((0, 1), (2, 4), (5, 9), (10, 20))
"""Numbers of contacts, from and to."""


def record(i: int) -> Record:
    """What the i-th state came to; of one without a step, ``none``."""
    found = state(i)
    if found is None:
        return {"i": i, "none": "no scene"}
    rng = np.random.default_rng([20, i])
    try:
        return {"i": i, "every": i % EVERY == 0, **judged(found, rng, i % EVERY == 0)}
    except StepNotSolved:
        return {"i": i, "none": "no step"}
    except ArithmeticError as failure:
        return {"i": i, "none": "no reference", "why": f"{found.group} {found.name}: {failure}"}


def records(count: int, log: Path | None) -> Iterator[Record]:
    """Records until `count` states are judged; those of the log first, new ones added to it."""
    done, every = 0, Log(log, itemgetter("i")).records(itertools.count(), record)
    while done < count:
        one = next(every)
        done += "none" not in one
        yield one


def error(one: Record) -> float:
    """Largest error of a record, relative to the largest entry of the same derivative.

    Where that is less than a thousandth of what the step without contacts shows, as of friction
    where nothing slides, relative to this.
    """
    shares = [
        wrong / (max(size, QUIET * free) or STILL)
        for wrong, size, free, _ in one["fields"].values()
    ]
    return max(shares, default=0.0)


def faulty(one: Record) -> bool:
    """Whether a number of a state is wrong, or stands where there is a kink."""
    return bool(one["kinks"]) or error(one) > WITHIN


def table(found: list[Record]) -> list[str]:
    """Rows by scenario and shapes, by numbers of contacts, by what they do, by derivative."""
    groups: dict[tuple[int, str], list[Record]] = defaultdict(list)
    for one in found:
        group, name = one["group"], one["name"]
        if group == "scenario":
            groups[0, f"`{name}`"].append(one)
        elif group == "crowd":
            groups[3, "cloud of 24 points, 1 to 20 kept"].append(one)
        elif group == "random":
            groups[4, "random mechanisms"].append(one)
        elif group == "pushes":
            for shape in dict.fromkeys(name.split("-")):
                a = "an" if shape == "ellipsoid" else "a"
                groups[1, f"pushes with {a} {shape}"].append(one)
        else:
            groups[2, "pairs of shapes of random sizes"].append(one)
        for first, last in COUNTS:
            if first <= one["contacts"] <= last:
                groups[5, f"{first} to {last} contacts"].append(one)
        for mode in one["modes"]:
            groups[6, f"a contact that is {mode}"].append(one)
    order = {f"a contact that is {mode}": k for k, mode in enumerate(MODES)}
    order |= {f"{first} to {last} contacts": first for first, last in COUNTS}
    keys = sorted(groups, key=lambda key: (key[0], order.get(key[1], 0), key[1]))
    return [_row(key[1], groups[key]) for key in [*keys]] + [_row("**all**", found)]


def _row(name: str, some: list[Record]) -> str:
    errors = [error(one) for one in some]
    refused = [one for one in some if one["reasons"]]
    median, worst = np.median(errors), np.max(errors)
    return f"| {name} | {len(some)} | {len(refused)} | {median:.0e} | {worst:.0e} |"


def by_field(found: list[Record]) -> list[str]:
    """Rows by derivative: states, directions, median and largest error."""
    rows = []
    for field in FIELDS:
        some = [one for one in found if field in one["fields"]]
        errors = [error({"fields": {field: one["fields"][field]}}) for one in some]
        turns = sum(one["fields"][field][3] for one in some)
        line = f"| `{field}` | {len(some)} | {turns} |"
        rows.append(f"{line} {np.median(errors):.0e} | {np.max(errors):.0e} |")
    return rows


def said(found: list[Record]) -> list[str]:
    """Sentences on verdicts."""
    refused: dict[str, list[bool]] = defaultdict(list)
    for one in found:
        for kind in one["reasons"]:
            refused[kind].append(any(one["refused"].values()))
    lines = [
        f"- {kind}: {len(seen)} states; in {sum(seen)} the reference has a kink or a tie there too"
        for kind, seen in sorted(refused.items())
    ]
    return lines or ["- none"]


def page(found: list[Record], missing: dict[str, int]) -> str:
    """The table as Markdown."""
    wrong = [one for one in found if error(one) > WITHIN]
    silent = [one for one in found if one["kinks"]]
    all_columns = sum(one["every"] for one in found)
    couples = len({one["name"] for one in found if one["group"] == "pushes"})
    left = ", ".join(f"{count} with {why}" for why, count in sorted(missing.items())) or "none"
    lines = [
        "# Derivatives of random states against differences without rounding",
        "",
        f"`python -m validation.make.derivative_states --states {len(found)}`. Each derivative "
        f"along two random directions (of h: one), of {all_columns} states along each column "
        "besides, against central differences over 2^-99 of steps that keep 96 decimal places. "
        "Errors are relative to the largest entry of the same derivative, or to a thousandth of "
        "what the step without contacts shows, where that is more.",
        "",
        f"{len(found)} states, in the pushes {couples} couples of shapes; {len(wrong)} with an "
        f"error above {WITHIN:g}; {len(silent)} in which a number stands where "
        f"the reference has a kink. Left out of the numbers drawn: {left}.",
        "",
        "| states | tried | with a verdict | median | worst |",
        "|---|---|---|---|---|",
        *table(found),
        "",
        "| derivative | states | directions | median | worst |",
        "|---|---|---|---|---|",
        *by_field(found),
        "",
        *(
            f"State {one['i']}, {one['group']} {one['name']}: an error of {error(one):.1e}.\n"
            for one in wrong
        ),
        "Verdicts, and the derivatives that they left out:",
        "",
        *said(found),
    ]
    return "\n".join(lines) + "\n"


def main(arguments: list[str] | None = None) -> int:
    """Write the table; 1 if a promise does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--states", type=int, default=3000)
    parser.add_argument("--log", type=Path)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args(arguments)
    every = list(records(options.states, options.log))
    found = [one for one in every if "none" not in one]
    missing: dict[str, int] = defaultdict(int)
    for one in every:
        if "none" in one:
            missing[one["none"]] += 1
            if "why" in one:
                print(one["i"], one["why"], file=sys.stderr)
    for one in found:
        if error(one) > WITHIN or one["kinks"]:
            print(f"state {one['i']}: {one}", file=sys.stderr)
    text = page(found, missing)
    if options.out is None:
        print(text, end="")
    else:
        text_written(options.out, text)
    return int(any(map(faulty, found)))


if __name__ == "__main__":
    sys.exit(main())
