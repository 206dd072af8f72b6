"""The stored steps of the prover's self-test: ``python -m validation.make.known_steps``.

Optima are those of the core's exact method. A step is taken while its proofs differ in kind from
those of the steps before, so that a small file has many kinds. What the library makes of each guess
is stored, too: a library that decides less is not used.
"""

import gzip
import io
import json
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, replace
from fractions import Fraction
from itertools import chain, takewhile
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref import Extra, StepData, StepInfeasible, contact_forces
from quasistatic_ref.certify.exact import group_optimum, joined_optimum
from quasistatic_ref.certify.minimiser import rational_solution
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.optional.fast.compiled.forces import Forces, knows
from quasistatic_ref.optional.fast.compiled.known_steps import FILE, Known, letter, tried
from quasistatic_ref.step.files import step_record
from quasistatic_ref.step.friction import friction_rows
from quasistatic_ref.step.groups import group_steps
from tests.oracles.random_steps import designed_step
from tests.oracles.rows_given import (
    DIGITS_MEET,
    at_rest,
    bounds_decide,
    compliances,
    divisible,
    forces_float64_misses,
    half_way,
    half_way_forces,
    matrices,
    sevenths,
    small_numbers,
    step_of,
    without_rows,
    without_slack,
)
from validation.make.degenerate_bits import degenerate_step
from validation.tools.scripts import script_options

SEEDS = 3000
EACH = 3
"""Steps of one kind: of equal family, size and outcomes of proofs."""
MOST = 405
CONES = ("pyramid", "frictionless", "facets-8")


def optimum_of(step: StepData) -> dict[str, Any] | None:
    """The exact optimum as it is stored; None of a step without solution."""
    divided = group_steps(step)
    try:
        optima = [group_optimum(step, group, own, []) for group, own in divided]
    except StepInfeasible:
        return None
    found = asdict(joined_optimum(step, [group for group, _ in divided], optima))
    form = exact_form(step)
    solution = rational_solution(form, found["working_set"])
    unit = form.x_unit / solution.denominator
    x = [Fraction(int(v.p), int(v.q)) for v in (unit * v for v in solution.x)]
    pairs = zip(x, found["delta_q"].tolist(), strict=True)
    found["rest"] = [float(v - Fraction(rounded)) for v, rounded in pairs]
    found["degeneracy"] = [[one.multipliers_unique, one.differentiable] for one in optima]
    stored = ("delta_q", "rest", "net", "lam", "slack", "working_set", "degeneracy")
    return {name: found[name] for name in stored}


def varied_step(seed: int) -> StepData:
    """A designed step, in one of three cones; with coordinates of other units in every second."""
    step = designed_step(seed)
    if seed // 4 % 2:
        units = 2.0 ** np.random.default_rng(seed).integers(-40, 40, step.n_v)
        of_a = units[: step.n_a]
        of_u = units[step.n_a :]
        contacts = step.contacts
        extra = step.extra
        step = step.replace(
            K_q=step.K_q * of_a * of_a[:, None],
            M_u=step.M_u * of_u * of_u[:, None],
            tau_a=step.tau_a * of_a,
            tau_u=step.tau_u * of_u,
            delta_q_bar_a=step.delta_q_bar_a / of_a,
            contacts=replace(contacts, J=contacts.J * units),
            extra=Extra(extra.names, extra.A * units, extra.b),
        )
    return step.replace(cone=CONES[seed // 8 % 3])


def nearly_pressed(seed: int) -> StepData:
    """A designed step: float64 hardly shows that one of its contacts bears nothing, or does."""
    rng = np.random.default_rng([seed, 5])
    step = designed_step(seed)
    forces = contact_forces(step)
    contacts = step.contacts
    j = rng.choice(np.flatnonzero(~forces.wrench.any(axis=1)))
    rows = friction_rows(contacts, step.cone)[j, : step.counts[j]] @ forces.delta_q
    off = float(rng.choice([-1, 1])) * 2.0 ** -int(rng.integers(40, 60))
    phi = contacts.phi.copy()
    phi[j] = -rows.min() + np.abs(rows).max() * off
    return step.replace(contacts=replace(contacts, phi=phi))


def chosen_steps() -> Iterator[StepData]:
    """Steps that refuse a wrong prover which others do not: ``prover_mutants``."""
    yield from (without_rows(1), without_rows(2))
    yield from (half_way(1), half_way(3), half_way(1, 40), sevenths(), divisible())
    yield from (*without_slack(), *small_numbers(), *matrices())
    yield from map(degenerate_step, (6, 22, 36, 41, 65))
    yield from (step_of(A, b, [0.0] * len(A[0])) for A, b in DIGITS_MEET)
    yield from compliances()
    yield half_way_forces(2.0**39 + 1.0)
    yield from (half_way_forces(2.0**39 + 5.0, gap) for gap in (2.0**-75, 2.0**-300))
    yield from (*forces_float64_misses(), at_rest())  # which has an even number
    yield from map(nearly_pressed, (2, 71, 90, 436, 438, 584, 724, 2404, 2530, 2851))


def main() -> int:
    """Write the file."""
    options = script_options(__doc__, out=Path)
    folder = tempfile.TemporaryDirectory()
    untested = Path(folder.name) / "untested.so"  # the file is what would test it
    subprocess.run(library.compiling(library.compiler(), untested), check=True)
    library.chosen = str(untested)
    kinds = Counter()
    lines = []
    seeds = takewhile(lambda _: len(lines) < MOST, range(SEEDS))
    designed = ((seed % 4, varied_step(seed)) for seed in seeds)
    first, last = enumerate(chosen_steps(), start=4), enumerate(bounds_decide(), start=100)
    for family, step in chain(first, designed, last):
        optimum = optimum_of(step)
        divided = group_steps(step)
        if optimum is None and len(divided) > 1:
            continue  # the group without solution is not known
        proofs = list(tried(Known(step, optimum, "", [], None, None)))
        outcomes = "".join(letter(one.code) for one in proofs)
        kind = family, step.cone, step.n_v, len(divided), "".join(sorted(set(outcomes)))
        told = optimum is None or set("or") & set(outcomes)
        if family < 4 and (kinds[kind] == EACH or not told):
            continue
        kinds[kind] += 1
        record = {
            "step": step_record(step), "optimum": optimum, "outcomes": outcomes,
            "digits": [one.digits for one in proofs],
        }  # fmt: skip
        if optimum is not None and knows(step.cone):
            record["left"] = Forces(step).in_c(step)[1]
            if not record["left"]:
                record["forces"] = contact_forces(step).wrench.tolist()
        lines.append(json_text(record))
    made = io.BytesIO()
    with gzip.GzipFile(fileobj=made, mode="wb", mtime=0) as packed:
        packed.write("\n".join(lines).encode())
    out = options.out or FILE
    out.write_bytes(made.getvalue())
    letters = Counter("".join(json.loads(line)["outcomes"] for line in lines))
    print(f"{len(lines)} steps, {len(made.getvalue())} bytes, outcomes {dict(letters)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
