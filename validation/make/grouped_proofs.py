"""Optima have the same bits whether they are proved whole or by group.

Run ``python -m validation.make.grouped_proofs --out FILE``: random steps and the steps of scenarios
(``--random`` of the first, ``--every`` so manyth of the others). Takes some minutes. Exit status 1
if a bit differs.
"""

import sys
from collections import Counter
from pathlib import Path

import numpy as np

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import ExactOptimum, form_optimum, step_optimum
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import StepIllPosed, StepInfeasible
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.scenes.at_random import divided
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import groups
from tests.oracles.random_steps import mixed_step
from validation.tools.scripts import script_options, show_page

SAME = (
    "delta_q",
    "net",
    "slack",
    "multipliers_unique",
    "differentiable",
    "smallest_inactive_slack",
)
"""What of an optimum no choice is left of."""


def random_case(seed: int) -> StepData:
    """A random step, mostly without what couples two or three classes of its coordinates."""
    rng = np.random.default_rng([seed, 3])
    return divided(rng, mixed_step(seed), int(rng.integers(1, 4)))


def faults(step: StepData) -> list[str]:
    """In what the optimum by group is not that of the whole; empty if it is."""
    whole = form_optimum(exact_form(step))
    try:
        grouped = step_optimum(step)
    except StepInfeasible as failure:
        if not isinstance(whole, Farkas):
            return ["infeasible by group only"]
        reason = farkas_refutation(step, failure.farkas.exact)
        return [] if reason is None else [reason]
    except StepIllPosed as failure:
        if isinstance(whole, Farkas):
            return ["feasible by group only"]
        return [] if failure.delta_q.tobytes() == whole.delta_q.tobytes() else ["delta_q"]
    return unlike_fields(grouped, whole)


def unlike_fields(one: ExactOptimum, whole: ExactOptimum | Farkas) -> list[str]:
    """In what of that no choice is left of an optimum is not that of the whole step."""
    if isinstance(whole, Farkas):
        return ["feasible by group only"]
    names = (*SAME, "lam") if whole.multipliers_unique else SAME
    return [name for name in names if bits(getattr(one, name)) != bits(getattr(whole, name))]


def comparison(random: int, every: int) -> tuple[list[str], list[str]]:
    """The table of how many steps were compared, whole and by group; what differs, in words."""
    found = Counter()
    wrong = []
    for seed in range(random):
        step = random_case(seed)
        found[f"random steps of {len(groups(step))} groups"] += 1
        wrong += [f"random step {seed}: {fault}" for fault in faults(step)]
    for name in scenario_names():
        run = load_scenario(name, fast=True).run(progress=False)
        for k in range(0, run.steps, every):
            found[f"steps of {name}"] += 1
            wrong += [f"{name}, step {k}: {fault}" for fault in faults(run.step_data(k))]
    return markdown_table(("steps", "compared"), sorted(found.items())), wrong


def main() -> int:
    """Compare, and write the page."""
    options = script_options(__doc__, random=1000, every=30, out=Path)
    steps, wrong = comparison(options.random, options.every)
    lines = [
        "# The same bits, proved whole and by group",
        "",
        "Written by `python -m validation.make.grouped_proofs`: `delta_q`, `A'lam`, slacks and "
        f"what is said of them, by group and of the whole step. {len(wrong)} steps differ.",
        "",
        *steps,
    ]
    show_page("\n".join(lines), options.out)
    print(*wrong, sep="\n", file=sys.stderr)
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
