"""The worst problems of each solver, each with the command that runs it again."""

import shlex
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.certify.digits import digits_of_error
from quasistatic_ref.lab.page.parts import Block, Table
from quasistatic_ref.lab.study.report.columns import Columns, Where, chosen
from quasistatic_ref.lab.study.report.numbers import digits, filter_words, milliseconds

SHOWN = 10


def worst_problems(
    columns: Columns,
    base: Where,
    ways: Sequence[tuple[str, str]],
    facts: Sequence[Mapping[str, Any]],
) -> list[Block]:
    """What a solver's author looks at first: a table for each, the most digits missed first.

    Parameters
    ----------
    columns : mapping of str to ndarray
    base : mapping
        Units, and warm or cold starts.
    ways : sequence of (str, str)
        Label and setting of each solver.
    facts : sequence of mapping
        Of the problems: how far the answer of each problem is known.
    """
    words = (
        "Each table is of one solver, at the setting and through the interface that deliver 6 "
        "digits soonest. It lists the calls whose answers miss the most of the known digits; of "
        "calls that miss equally many, the slowest come first. The command runs the solver on the "
        "problem again, with the same options, and prints how wrong the answer is; "
        "`--store FOLDER` names the folder of this study, which the command needs for problems and "
        "solvers that only this study has."
    )
    known = {fact["id"]: digits_of_error(fact["bound"]) for fact in facts}
    tables = (_table(columns, {**base, "setting": s}, label, known) for label, s in ways)
    return [words, *tables]


def ask_command(row: Columns, i: int) -> str:
    """The command that repeats one measurement.

    Parameters
    ----------
    row : mapping of str to ndarray
    i : int
        Which of the rows.
    """
    words = [str(row[name][i]) for name in ("problem", "way", "setting")]
    units = [] if row["units"][i] == "natural" else ["--units", str(row["units"][i])]
    start = ["--warm"] if row["warm"][i] else []
    return shlex.join(["quasistatic-ref", "study", "ask", *words, *units, *start])


def _table(columns: Columns, where: Where, label: str, known: Mapping[str, float]) -> Table:
    own = chosen(columns, {**where, "label": label})
    most = np.array([known[str(name)] for name in own["problem"]])
    missed = np.maximum(most - own["digits"], 0.0)
    order = np.lexsort((own["problem"], -own["seconds"], -missed))[:SHOWN]
    rows = tuple(
        (
            str(own["problem"][i]), str(own["outcome"][i]), str(own["claimed"][i]),
            "yes" if own["wrong"][i] else "no", f"`{ask_command(own, i)}`",
            digits(float(own["digits"][i])), digits(float(most[i])),
            milliseconds(float(own["seconds"][i])),
        )
        for i in order
    )  # fmt: skip
    names = ("problem", "outcome", "its own status", "false claim", "command", "digits",
             "digits known", "time [ms]")  # fmt: skip
    title = f"Worst {SHOWN} problems of {label} at {where['setting']}."
    return Table(title, filter_words({**where, "label": label}), names, rows, left=5)
