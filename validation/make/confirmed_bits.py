"""A guess that C proves ends at the bits of the exact method: each wrong one is seen.

Run ``python -m validation.make.confirmed_bits --out FILE`` (two minutes on two cores; ``--random``
makes it shorter). Random steps of every polyhedral cone, degenerate ones among them, as they are
and in units up to 2^40 apart. Of each, the exact method finds a working set from cold. C is then
given that set, and others that are wrong: without a row, with one more, with one exchanged, and
random ones. What it proves must be equal in every bit to what the exact method makes of the same
guess. (Where multipliers are not unique, some of these sets hold the optimum as well: "also
right".) "Nearby" are wrong sets from which walks in float64 lead to one that is proved.

Prints a table, and exits with status 1 if a bit differs.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields
from pathlib import Path

import numpy as np
from tqdm import tqdm

from quasistatic_ref import StepData
from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.fast.compiled.certificate import Prover
from quasistatic_ref.optional.fast.compiled.library import why_not
from quasistatic_ref.solve.units import DenseStepInBothUnits, Units, natural_step
from quasistatic_ref.step.data import Indices
from quasistatic_ref.step.groups import Group
from tests.oracles.random_steps import mixed_step
from validation.tools.scripts import script_options, show_page

CONES = ("pyramid", "product", "facets-6", "facets-8", "frictionless")
COLUMNS = (
    "optima", "infeasible", "proved", "left open", "wrong sets", "refused", "also right", "nearby",
)  # fmt: skip


NEARBY = {"walks"}
"""In what may differ from the exact optimum what is proved near a wrong guess."""

OTHERS = NEARBY | {"lam", "working_set", "smallest_active_multiplier"}
"""The same where multipliers are not unique."""


def random_case(seed: int) -> tuple[str, StepData]:
    """A random step, its cone and units; the seed decides."""
    rng = np.random.default_rng([seed, 1])
    cone = CONES[seed % len(CONES)]
    step = mixed_step(seed // len(CONES)).replace(cone=cone)
    if seed % 2:
        return cone, step
    apart = Units(2.0 ** rng.integers(-20, 21, step.n_v), 2.0 ** int(rng.integers(-20, 21)), 1.0)
    return f"{cone}, badly scaled", natural_step(step, apart)


def wrong_sets(rng: np.random.Generator, working: list[int], m: int) -> Iterator[list[int]]:
    """Sets of rows that are others than the working set."""
    others = sorted(set(range(m)) - set(working))
    if working:
        out = int(rng.choice(working))
        rest = [i for i in working if i != out]
        yield rest
        if others:
            yield [*rest, int(rng.choice(others))]
    if others:
        yield [*working, int(rng.choice(others))]
    if m:
        yield rng.choice(m, size=min(m, 1 + len(working)), replace=False).tolist()


def ascending(guess: list[int]) -> Indices:
    """The rows of a guess, each once, shape (k,)."""
    return np.array(sorted(set(guess)), dtype=np.int64)


def differing_fields(one: ExactOptimum, other: ExactOptimum | Farkas) -> list[str]:
    """Names of the fields in which two optima differ in any bit."""
    names = ["slack" if f.name == "slacks" else f.name for f in fields(one)]
    return [name for name in names if bits(getattr(one, name)) != bits(getattr(other, name, None))]


def proof(step: StepData, rows: Indices, *, nearby: bool = False) -> ExactOptimum | None:
    """What C proves on a guess, or also near it, where there is a compiler."""
    if why_not() is not None:
        return None
    both = DenseStepInBothUnits(step)
    sizes = step.n_v, step.contacts.n_c, len(step.extra.names), step.m
    prover = Prover(both, [(Group(*map(np.arange, sizes)), step, both.hessian)])
    pressed = np.zeros(step.m)
    pressed[rows if nearby else []] = 1.0
    prover.optimum(both, pressed, np.zeros(step.m))
    (own,) = prover.proofs
    if own is None:
        return None
    return own.nearby(both.units) if nearby else own.on(rows, both.units)


def seed_outcome(seed: int) -> tuple[str, Counter[str], list[str]]:
    """The kind of a random step, what was found on it, and faults in words."""
    kind, step = random_case(seed)
    found = Counter()
    faults = []
    rng = np.random.default_rng([seed, 2])
    form = exact_form(step)
    truth = form_optimum(form)

    def answer(guess: list[int]) -> ExactOptimum | None:
        """What C proves, compared with the exact method."""
        one = proof(step, ascending(guess))
        if one is not None and (wrong := differing_fields(one, form_optimum(form, guess))):
            faults.append(f"{kind}, step {seed}, from {guess}: {', '.join(wrong)}")
        return one

    if isinstance(truth, Farkas):
        found["infeasible"] += 1
        right = []
    else:
        found["optima"] += 1
        right = list(truth.working_set)
        found["left open" if answer(right) is None else "proved"] += 1
    for guess in wrong_sets(rng, right, form.m):
        found["wrong sets"] += 1
        found["refused" if answer(guess) is None else "also right"] += 1
        if (near := proof(step, ascending(guess), nearby=True)) is not None:
            found["nearby"] += 1
            may = NEARBY if near.multipliers_unique else OTHERS
            if wrong := sorted(set(differing_fields(near, truth)) - may):
                faults.append(f"{kind}, step {seed}, near {guess}: {', '.join(wrong)}")
    return kind, found, faults


def main() -> int:
    """Check, print and write the table; exit status 1 if a bit differs."""
    options = script_options(__doc__, random=5000, out=Path)
    found = {}
    faults = []
    with ProcessPoolExecutor() as pool:
        outcomes = pool.map(seed_outcome, range(options.random), chunksize=16)
        for kind, counts, wrong in tqdm(outcomes, total=options.random):
            found.setdefault(kind, Counter()).update(counts)
            faults += wrong
    found["all"] = sum(found.values(), Counter())
    lines = [f"{'':24}" + "".join(f"{name:>12}" for name in COLUMNS)]
    for kind in sorted(found, key=lambda kind: (kind == "all", kind)):
        lines.append(f"{kind:24}" + "".join(f"{found[kind][name]:>12}" for name in COLUMNS))
    lines += faults or ["What was proved has the bits of the exact method, in every field."]
    show_page("\n".join(lines), options.out)
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
