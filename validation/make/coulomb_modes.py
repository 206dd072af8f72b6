"""Planar steps under Coulomb's law: ``python -m validation.make.coulomb_modes --out FILE``.

Each of ``--steps`` random steps (half an hour for 2500, ``--jobs`` at once; records are kept with
``--log``, and a run that was stopped goes on from them) is taken by
`coulomb_step`, and its solutions are counted by `coulomb_solutions`. An enumeration in fractions,
which shares no code with the package, says what is right: how many solutions there are, each
isolated one to the last bit, and whether the step that was taken is one of them. The page says how
many the iteration alone, without extrapolation and modes, does not find. Exit status 1 if anything
is wrong.
"""

import sys
from collections import Counter
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from quasistatic_ref import (
    NoCoulombSolution,
    StepData,
    StepInfeasible,
    coulomb_solutions,
    coulomb_step,
    solve_step,
)
from quasistatic_ref.lab.log import Log, Record
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.parallel import results, workers
from quasistatic_ref.optional.coulomb.fixed_point import MOST, longest_slips, slip_norms
from quasistatic_ref.tolerances import COULOMB_RESIDUAL
from tests.oracles.planar_coulomb import planar_solutions
from tests.oracles.planar_steps import KINDS, planar_step
from validation.tools.scripts import script_options, show_page

NEAR = 1e-9
"""Distance of a step from a solution, over the longest of all [-]: s is its own to within 1e-12 of
the longest slip, and the steps of the wedge amplify that."""
COLUMNS = ("none", "one", "several", "a set", "not found before", "wrong")
INTRODUCTION = """# Planar steps under Coulomb's law

Random steps of one body with one to four contacts and friction of 0.1 to 5, and how many solutions
they have by an enumeration in fractions (`python -m validation.make.coulomb_modes`): none, one,
several that are isolated, or a set of infinitely many. On the floor contacts are the corners of a
box; elsewhere they have normals of any direction; wedges have normals that nearly or exactly face
each other; deep ones begin in penetration. Not found before: by the iteration alone, in 200 convex
steps, of a step that has a solution. Wrong: another count, another isolated solution, or a step
that is not taken to one of its solutions.
"""


def step_verdict(step: StepData) -> tuple[str, str]:
    """How many solutions a step has by the enumeration, and what is said of it that is wrong."""
    points, sets = planar_solutions(step)
    count = "a set" if sets else ("none", "one")[len(points)] if len(points) < 2 else "several"
    said = coulomb_solutions(step)
    if said.count != ("several" if count == "a set" else count):
        return count, f"{said.count} for {count}"
    isolated = set()
    others = []
    for modes in product(*said.modes) if said.modes else ():  # one of each group
        x = np.zeros(step.n_v)
        for mode in modes:
            x[mode.coordinates] = mode.delta_q
        if all(mode.isolated for mode in modes):
            isolated.add(tuple(x.tolist()))
        else:
            others.append(x)
    if isolated != {tuple(float(x) for x in point) for point in points}:
        return count, "another isolated solution"
    try:
        found = coulomb_step(step, "none")
    except NoCoulombSolution:
        return count, "" if count == "none" else "a solution that is not seen"
    if not found.found:
        return count, "not found"
    places = [[(x, x) for x in point] for point in points] + sets
    right = all(any(_near(x, place) for place in places) for x in (found.delta_q, *others))
    return count, "" if right else "no solution"


def _near(x: np.ndarray, place: list[Any]) -> bool:
    """Whether x is within the bounds of each coordinate, or near to them."""
    low = np.array([-np.inf if a is None else float(a) for a, _ in place])
    high = np.array([np.inf if b is None else float(b) for _, b in place])
    off = NEAR * max(np.abs(x).max(), np.abs(low[np.isfinite(low)]).max(initial=0.0))
    return bool(((low - off <= x) & (x <= high + off)).all())


def iteration_ends(step: StepData) -> bool:
    """Whether the iteration alone finds a fixed point."""
    s = np.zeros(step.contacts.n_c)
    for _ in range(MOST):
        raised = step.replace(contacts=step.contacts.raised(s))
        try:
            delta_q = solve_step(raised, "none").delta_q
        except StepInfeasible:
            return False
        own = slip_norms(step, delta_q)
        if np.abs(own - s).max() <= COULOMB_RESIDUAL * longest_slips(step, delta_q).max():
            return True
        s = own
    return False


def step_record(i: int) -> Record:
    """A step by its number: its count, whether the iteration misses it, and what is wrong."""
    step = planar_step(np.random.default_rng([0, i]), KINDS[i % len(KINDS)])
    count, wrong = step_verdict(step)
    missed = count != "none" and not iteration_ends(step)
    return {"step": i, "count": count, "missed": missed, "wrong": wrong}


def main() -> int:
    """Write the page; exit status 1 if anything is wrong."""
    options = script_options(__doc__, steps=2500, jobs=2, log=Path, out=Path)
    log = Log(options.log, lambda record: record["step"])
    tasks = [(i,) for i in range(options.steps) if i not in log.found]
    with workers(options.jobs) as executor:
        for record in tqdm(results(executor, options.jobs, step_record, tasks), total=len(tasks)):
            log.add(record)
    rows = {kind: Counter[str]() for kind in KINDS}
    found = []
    for i in range(options.steps):
        one = log.found[i]
        row = rows[KINDS[i % len(KINDS)]]
        row[one["count"]] += 1
        row["not found before"] += one["missed"]
        row["wrong"] += bool(one["wrong"])
        if one["wrong"]:
            found.append(f"- step {i}: {one['wrong']}")
    rows["all"] = sum(rows.values(), Counter[str]())
    cells = [
        (kind, sum(n for word, n in row.items() if word in COLUMNS[:4]), *(row[c] for c in COLUMNS))
        for kind, row in rows.items()
    ]
    table = markdown_table(("contacts", "steps", *COLUMNS), cells, left=1)
    show_page("\n".join([INTRODUCTION, *table, *found]), options.out)
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
