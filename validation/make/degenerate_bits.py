"""Steps that are degenerate by construction: C and the exact method agree in every bit and claim.

Run ``python -m validation.make.degenerate_bits --out FILE`` (``--random`` is the number of steps).
With ``--first`` N a run goes on from step N, and adds to what the file says of the steps before.
Boxes stand on each other and on a floor, some between two walls, with equal gaps everywhere. Some
contacts occur twice, some forces are zero, and pushes are along an axis. So most slacks and
coordinates are exactly zero, or tie exactly. Of each step the exact method finds the optimum from
cold. C is given its working set, and a working set with one row less; what it proves must have the
bits, the status and the claims of what the exact method makes of that set.

Prints a table, and exits with status 1 if anything differs.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from quasistatic_ref import StepData
from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.contacts import GRAVITY, X, Y, Z, contacts_of, point_jacobian
from quasistatic_ref.lab.scenes.contacts import repeated as some_of
from quasistatic_ref.lab.scenes.rigid import free_step
from validation.make.confirmed_bits import CONES, differing_fields, proof
from validation.tools.scripts import script_options, show_page

CORNERS = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)], dtype=np.float64)
UP, RIGHT, LEFT = (X, Y, Z), (Y, Z, X), (Z, Y, -X)
"""Frames (d1, d2, n) of a floor, and of walls to the left and to the right of a box."""
COLUMNS = ("optima", "infeasible", "proved", "left open", "unique", "differentiable", "one less")

SAME = "What C proved has the bits and claims of the exact method."


def degenerate_step(seed: int) -> StepData:
    """A stack of one to three boxes, pushed along an axis or not at all; the seed decides."""
    rng = np.random.default_rng([seed, 3])
    boxes = int(rng.choice([1, 1, 2, 3]))
    sides = rng.choice([0.04, 0.05, 0.0625], 3) if rng.random() < 0.5 else np.full(3, 0.04)
    mass = float(rng.choice([0.2, 0.5, 1.0]))
    inertia = mass / 12 * (np.sum(sides**2) - sides**2)
    gap = float(rng.choice([0.0, 0.0, 1e-4, 2.0**-13, -1e-5]))
    phi, frames, J = [], [], []
    for box in range(boxes):
        for corner in CORNERS:
            of_upper = np.array([*corner, -1.0]) * sides / 2
            own = np.zeros((4, 6 * boxes))
            own[:, 6 * box : 6 * box + 6] = point_jacobian(of_upper, Z)
            if box:
                of_lower = of_upper + sides * Z
                own[:, 6 * box - 6 : 6 * box] = -point_jacobian(of_lower, Z)
            phi.append(gap)
            frames.append(UP)
            J.append(own)
    for side, frame in ((-1.0, RIGHT), (1.0, LEFT)) if rng.random() < 0.3 else ():
        for corner in CORNERS:
            own = np.zeros((4, 6 * boxes))
            own[:, :6] = point_jacobian(np.array([side, *corner]) * sides / 2, frame[2])
            phi.append(gap if gap > 0 else 0.0)  # pushed out by both walls there is no step
            frames.append(frame)
            J.append(own)
    contacts = contacts_of(
        phi, frames, J, rng.choice([0.0, 0.3, 0.5]), rng.choice([0.0, 0.01]), rng.choice([4, 6])
    )
    twice = np.flatnonzero(rng.random(len(phi)) < rng.choice([0.0, 0.2]))
    contacts = some_of(contacts, [*range(len(phi)), *twice])
    weight = mass * GRAVITY * float(rng.choice([0.0, 1.0, 1.0]))
    force = np.tile([0.0, 0.0, -weight, 0.0, 0.0, 0.0], boxes)
    axis = int(rng.integers(6))
    size = weight * (1.0 if axis < 3 else 0.01)
    force[axis] += size * float(rng.choice([0.0, 0.2, 0.5, 2.0])) * rng.choice([-1.0, 1.0])
    M = np.diag(np.tile([mass, mass, mass, *inertia], boxes))
    h = float(rng.choice([0.01, 2.0**-6]))
    return free_step(M, force, contacts, h).replace(cone=str(rng.choice(CONES)))


def faults(seed: int) -> tuple[Counter[str], list[str]]:
    """What was found on a step, and in what C differs, in words."""
    step = degenerate_step(seed)
    form = exact_form(step)
    truth = form_optimum(form)
    if isinstance(truth, Farkas):
        return Counter(infeasible=1), []
    found = Counter(optima=1, unique=truth.multipliers_unique, differentiable=truth.differentiable)
    wrong = []
    right = truth.working_set
    for working in (right, right[:-1]) if right else (right,):
        answer = proof(step, np.array(sorted(working), dtype=np.int64))
        if answer is None:
            found["left open"] += working is right
            continue
        found["proved" if working is right else "one less"] += 1
        names = set(differing_fields(answer, form_optimum(form, working)))
        if names:
            wrong.append(f"step {seed}, from {working}: {', '.join(sorted(names))}")
    return found, wrong


def outcomes(seeds: range) -> Iterator[tuple[Counter[str], list[str]]]:
    """Those of many steps, in the order of their seeds."""
    with ProcessPoolExecutor() as pool:
        yield from pool.map(faults, seeds, chunksize=64)


def before(page: str) -> tuple[dict[str, int], list[str]]:
    """The numbers of a page, and what it says is wrong."""
    lines = page.splitlines()
    numbers = [line.rsplit(maxsplit=1) for line in lines[: len(COLUMNS)]]
    return {name: int(number) for name, number in numbers}, [
        line for line in lines[len(COLUMNS) :] if line != SAME
    ]


def main() -> int:
    """Compare, print and write the table; exit status 1 if anything differs."""
    options = script_options(__doc__, first=0, random=100_000, out=Path)
    found = Counter[str]()
    wrong = list[str]()
    if options.first:
        counts, wrong = before(options.out.read_text())
        found.update(counts)
    for counts, words in outcomes(range(options.first, options.first + options.random)):
        found.update(counts)
        wrong += words
    lines = [f"{name:16}{found[name]:>8}" for name in COLUMNS]
    lines += wrong or [SAME]
    show_page("\n".join(lines), options.out)
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
