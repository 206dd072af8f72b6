"""Each family of ``contact-qp-2`` at both ends of its dial.

Run ``python -m validation.make.contact_qp``.

Four solvers are called at 1e-9 in natural units, once each and without a clock: what is compared
are correct digits and iterations. Two minutes; ``--every N`` takes each N-th problem only.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.digits import relative_digits
from quasistatic_ref.lab.folders import CONTACT_QP_2, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.study.calling.calls import tried
from quasistatic_ref.lab.study.calling.native import Native
from quasistatic_ref.lab.study.calling.options import options_at
from quasistatic_ref.lab.study.problems.families.dials import ends
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.problem import Problem
from validation.tools.scripts import asked, shown

SOLVERS = ("daqp", "piqp", "clarabel", "osqp")
ACCURACY = 1e-9
PARTS = 5
"""Of a dial, with equally many problems each."""
HEAD = ("family", "dial", "solver", "digits of nine in ten, easy fifth", "of the hard fifth",
        "solved [%], easy", "solved [%], hard", "iterations, easy", "iterations, hard")  # fmt: skip


class Graded(NamedTuple):
    """What a solver says to a problem, and how many digits of it are right."""

    solved: bool
    digits: float
    iterations: int | None


def graded(one: Problem, solver: str) -> Graded:
    """One call; an answer that is not called solved has no digits."""
    natural = one.natural
    options = options_at(solver, "native", ACCURACY)
    reply = tried(Native(solver), natural.form, options)
    digits = 0.0
    if reply.solved and reply.x is not None and one.feasible:
        H = natural.H.toarray()
        off = np.asarray(reply.x) - natural.answer.x
        free = float(natural.g @ np.linalg.solve(H, natural.g))
        digits = relative_digits(float(np.sqrt(off @ H @ off)), float(np.sqrt(free)))
    return Graded(reply.solved, digits, reply.iterations)


def cells(some: Sequence[Graded], feasible: bool) -> tuple[str, str, str]:
    """Digits of nine in ten, share that is called solved [%], and median of the iterations."""
    digits = f"{np.quantile([one.digits for one in some], 0.1):.1f}" if feasible else ""
    solved = f"{100 * np.mean([one.solved for one in some]):.1f}"
    known = [one.iterations for one in some if one.iterations is not None]
    return digits, solved, f"{np.median(known):g}" if known else ""


def lines(every: Sequence[Problem]) -> Iterator[tuple[str, ...]]:
    """A line for each family with a dial, and each solver."""
    for family, members in groupby(every, lambda one: str(one.facts["family"])):
        dial = ends(family)
        if dial is None:
            continue
        falls = dial["first"] > dial["most"]
        own = sorted(members, key=lambda one: float(one.facts["dial"]), reverse=falls)
        fifth = max(len(own) // PARTS, 1)
        unit = "" if dial["unit"] == "-" else f" {dial['unit']}"
        words = f"{dial['name']}, {dial['first']:g} to {dial['most']:g}{unit}"
        for solver in SOLVERS:
            easy, hard = (
                cells([graded(one, solver) for one in part], part[0].feasible)
                for part in (own[:fifth], own[-fifth:])
            )
            pairs = zip(easy, hard, strict=True)
            yield f"`{family}`", words, solver, *(cell for pair in pairs for cell in pair)


def main() -> None:
    """Write the table."""
    options = asked(__doc__, every=1, out=Path)
    every = set_read(problem_set_folder(CONTACT_QP_2))[:: options.every]
    shown("\n".join(markdown_table(HEAD, list(lines(every)), left=3)), options.out)


if __name__ == "__main__":
    main()
