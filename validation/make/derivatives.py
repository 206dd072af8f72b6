"""Derivatives of steps against differences, and their time.

Run ``python -m validation.make.derivatives``.

Pushes of every couple of shapes in random poses, and random states about the runs of all scenarios;
of each a random direction of q and one of the target. The reference is Richardson's combination of
central differences of exact steps, at four sizes of the step, of which the one nearest to the
claim counts, since a kink may be near. Exit status 1 if a promise does not hold.
"""

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.scenes.pushes import SHAPES, pushed
from quasistatic_ref.optional.derivatives.derivatives import derivatives

COUPLES = [(a, b) for a in SHAPES for b in SHAPES if not a == b == "cloud"]
STEPS = (1e-5, 1e-6, 1e-7, 3e-8)
"""Of the differences [m or rad]."""
WITHIN = 1e-7
"""Largest difference that is promised, relative to the largest entry of the same derivative."""
MILLISECONDS = 10.0
"""Longest that all derivatives of a step of bunny_grasp may take, the median of processor time."""


def unit(rng, n):
    """A random unit vector."""
    e = rng.normal(size=n)
    return e / np.linalg.norm(e)


def after(simulator, q_next, q, q_bar_a, force=0.0):
    """The end of a step, as seen from q_next."""
    return simulator.system.difference(q_next, simulator.step(q, q_bar_a, force).q)


def rate(function, step=1e-5):
    """Derivative at 0 of a function of one number: Richardson's of two central differences."""
    near, far = ((function(h) - function(-h)) / (2 * h) for h in (step, 2 * step))
    return (4 * near - far) / 3


def nearest(function, claimed, size):
    """How far some differences are from what is claimed, relative to a size: the first good one."""
    errors = []
    for step in STEPS:
        errors.append(np.abs(rate(function, step) - claimed).max() / (size or 1.0))
        if errors[-1] <= 1e-2 * WITHIN:
            break
    return min(errors)


def wrong_by(simulator, q, q_bar_a, found, rng, direction=None):
    """How far dq_dq and dq_dq_bar_a are from differences along a direction each."""
    system, start = simulator.system, found.result.q
    e = unit(rng, system.n_v) if direction is None else direction
    whole = system.with_actuated(q, q_bar_a)

    def moved(t):
        return after(simulator, start, system.integrate(q, t * e), q_bar_a)

    errors = [nearest(moved, found.dq_dq @ e, np.abs(found.dq_dq).max())]
    if system.n_a:
        way = unit(rng, system.n_a)
        change = np.concatenate([way, np.zeros(system.n_u)])

        def aimed(t):
            target = system.integrate(whole, t * change)[: system.n_q_a]
            return after(simulator, start, q, target)

        size = np.abs(found.dq_dq_bar_a).max()
        errors.append(nearest(aimed, found.dq_dq_bar_a @ way, size))
    return tuple(errors)


def pushes(per_couple):
    """(error, reasons) of random pushes of every couple of shapes."""
    for seed in range(per_couple):
        for i, couple in enumerate(COUPLES):
            rng = np.random.default_rng([seed, i])
            k = (1, 2, 4)[seed % 3]
            simulator, q, q_bar_a = pushed(rng, *couple, k=k, gap=(1e-4, -1e-4)[seed % 2])
            found = derivatives(simulator, q, q_bar_a)
            yield compared(simulator, q, q_bar_a, found, rng)


def states(name, count, away=1e-3):
    """(error, reasons) of states about the run of a scenario."""
    scenario = load_scenario(name, fast=True)
    simulator, system = scenario.simulator(), scenario.system
    run = scenario.run(progress=False)
    rng = np.random.default_rng(len(name))
    for k in rng.choice(run.steps, count, replace=False).tolist():
        q = system.integrate(run.q[k], away * unit(rng, system.n_v))
        q_bar_a = scenario.targets((k + 1) * scenario.h)
        found = derivatives(simulator, q, q_bar_a)
        yield compared(simulator, q, q_bar_a, found, rng)


def compared(simulator, q, q_bar_a, found, rng):
    """The error, or None where dq_dq does not exist; and the reasons for that."""
    kinds = {why.kind for why in found.reasons if "dq_dq" in why.fields}
    if kinds:
        return None, kinds
    return max(wrong_by(simulator, q, q_bar_a, found, rng)), kinds


def milliseconds(count=60):
    """Median processor time of all derivatives of a step of bunny_grasp, the step included."""
    scenario = load_scenario("bunny_grasp", steps=count + 20, fast=True)
    simulator, run = scenario.simulator(), scenario.run(progress=False)
    spent = []
    for k in range(20, count + 20):
        target = scenario.targets((k + 1) * scenario.h)
        start = time.process_time()
        derivatives(simulator, run.q[k], target)
        spent.append(1e3 * (time.process_time() - start))
    return float(np.median(spent))


def row(name, found):
    """A line of the table, and whether it is as promised."""
    errors = [error for error, _ in found if error is not None]
    kinds = Counter(kind for _, every in found for kind in every)
    said = ", ".join(f"{kind} {count}" for kind, count in sorted(kinds.items())) or "none"
    median, worst = (np.median(errors), np.max(errors)) if errors else (0.0, 0.0)
    line = f"| {name} | {len(found)} | {len(errors)} | {median:.0e} | {worst:.0e} | {said} |"
    return line, bool(worst <= WITHIN)


def main():
    """Write the table; 1 if a promise does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--per-couple", type=int, default=6)
    parser.add_argument("--states", type=int, default=12)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rows = [row("pushes of all couples of shapes", list(pushes(options.per_couple)))]
    for name in scenario_names():
        rows.append(row(f"`{name}`", list(states(name, options.states))))
    spent = milliseconds()
    lines = [
        "# Derivatives of steps against differences",
        "",
        "`python -m validation.make.derivatives`. Largest difference along a random direction of q "
        "and of the target, relative to the largest entry of the same derivative.",
        "",
        "| states | tried | with dq_dq | median | worst | reasons where there is none |",
        "|---|---|---|---|---|---|",
        *(line for line, _ in rows),
        "",
        f"All derivatives of a step of `bunny_grasp`, the step included: {spent:.1f} ms of "
        f"processor time in the median, of {MILLISECONDS:g} ms promised.",
    ]
    text = "\n".join(lines) + "\n"
    if options.out is None:
        print(text, end="")
    else:
        text_written(options.out, text)
    return int(not (all(good for _, good in rows) and spent <= MILLISECONDS))


if __name__ == "__main__":
    sys.exit(main())
