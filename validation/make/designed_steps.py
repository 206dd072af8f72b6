"""Small steps that are hard to prove, at both speeds: ``python -m validation.make.designed_steps``.

The steps of ``tests.oracles.random_steps.designed_step`` have exact ties, rows that depend on each
other, equal groups with different rows of a user's own, and loads and gaps of sizes from 2^-300 to
2^300. Each is solved plainly and by ``fast``. Both must have the same bits, and these must be those
of the optimum in fractions, which is proved on the working set of the answer without the package.
Of a step without solution both must give a proof that holds in fractions. ``--count`` steps, 20,000
unless it is said, from ``--first`` on, which are added to the counts of the page of those before.
Exit status 1 if one of them is wrong. Takes some minutes.
"""

import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path

from quasistatic_ref import StepData, StepIllPosed, StepInfeasible, StepNotSolved
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.fast.rechecked import DETERMINED
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.tolerances import ACCURACY
from tests.oracles.random_steps import designed_step
from tests.oracles.rational_kkt import exact, proved_optimum
from tests.oracles.solution_truth import nearest_float, program, proof
from validation.tools.scripts import rows_before, script_options, show_page

FAMILIES = ("any step", "equal groups with own rows", "ties in integers", "divided, with own rows")
OUTCOMES = ("same optimum", "no solution", "ill-posed", "wrong")
PAGE = """# Small steps that are hard to prove, at both speeds

Written by `python -m validation.make.designed_steps --out FILE`, which says what is compared.
`same optimum`: plain and `fast` have the same bits, which are those of the optimum in fractions.
`no solution`: both prove it, and the proofs hold in fractions. `ill-posed`: both refuse the step,
since its optimum is absurdly long.

| family | steps | {columns} |
|---|---|{lines}|
{rows}
"""


def by_fast(step: StepData) -> object:
    """The optimum by `fast`, started from DAQP where that has an answer."""
    solver = solver_for(step, "daqp", fast=True)
    both = solver.in_both_units(step)
    answer = None
    with suppress(StepNotSolved):  # the exact method starts cold
        answer = solver.answer(both, ACCURACY)
    return solver.prover.optimum(both, answer)


def outcome(step: StepData) -> str:
    """What both speeds come to; "wrong: ..." if that is not the truth."""
    found = []
    for speed in (step_optimum, by_fast):
        try:
            found.append(speed(step))
        except (StepInfeasible, StepIllPosed) as refused:
            found.append(refused)
    plain, fast = found
    if type(plain) is not type(fast):
        return f"wrong: {type(plain).__name__} and {type(fast).__name__}"
    if isinstance(plain, StepIllPosed):
        return "ill-posed"
    if isinstance(plain, StepInfeasible):
        right = all(proof(step, exact(one.farkas.exact)) for one in found)
        return "no solution" if right else "wrong: a proof that there is no solution"
    for name in DETERMINED:
        if bits(getattr(plain, name)) != bits(getattr(fast, name)):
            return f"wrong: {name} differs"
    of = program(step)
    try:
        x, lam, slack = proved_optimum(of, fast.working_set)
    except ArithmeticError as failure:
        return f"wrong: {failure}"
    net = lam @ of[2][list(fast.working_set)]
    pairs = (fast.delta_q, x), (fast.net, net), (fast.slack, slack)
    right = all([nearest_float(v) for v in truth] == list(numbers) for numbers, truth in pairs)
    positive = [nearest_float(v) for v in lam] == fast.lam[list(fast.working_set)].tolist()
    return "same optimum" if right and positive and all(v > 0 for v in lam) else "wrong: a number"


def counts_before(out: Path | None, first: int) -> list[Counter[str]]:
    """The counts of each family on the page of the steps before the first; else none."""
    if not first or out is None:
        return [Counter() for _ in FAMILIES]
    rows = rows_before(out)
    if not {*FAMILIES} <= {*rows}:
        sys.exit(f"{out}: holds no counts of the steps before {first}; leave out --first")
    kept = [map(int, rows[family][1:]) for family in FAMILIES]
    found = [Counter(dict(zip(OUTCOMES, counts, strict=True))) for counts in kept]
    assert sum(count.total() for count in found) == first
    return found


def main() -> int:
    """Compare all; exit status 1 if one is wrong."""
    options = script_options(__doc__, count=20000, first=0, out=Path)
    counts = counts_before(options.out, options.first)
    for seed in range(options.first, options.first + options.count):
        words = outcome(designed_step(seed))
        kind = words.split(":")[0]
        counts[seed % len(FAMILIES)][kind] += 1
        if kind == "wrong":
            print(seed, words, file=sys.stderr, flush=True)
    rows = [
        f"| {family} | {count.total()} | {' | '.join(str(count[kind]) for kind in OUTCOMES)} |"
        for family, count in zip(FAMILIES, counts, strict=True)
    ]
    columns = " | ".join(OUTCOMES)
    page = PAGE.format(
        columns=columns, lines="|".join("---" for _ in OUTCOMES), rows="\n".join(rows)
    )
    show_page(page, options.out)
    return int(any(count["wrong"] for count in counts))


if __name__ == "__main__":
    sys.exit(main())
