"""Both engines take the bunny the same way: ``python -m validation.engines_agree [STEPS]``.

Both bunny_grasp runs, certified in full, through the engine ``cvxpy`` and the engine ``native``
with several backends: q, delta_q, the data of every step, and the exact A'lam and slacks that each
run's own multipliers lead to must be equal, bit for bit. (lam itself is not unique in a sticking
grasp.) Prints a line for each run; exit status 1 if one differs.
"""

from __future__ import annotations

import sys

import numpy as np

from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.backends import installed

DATA = ("q", "delta_q", "phi", "J", "H", "g", "A", "b")


def differences(one: Trajectory, two: Trajectory) -> list[str]:
    """What differs between two certified runs, in words."""
    found = [name for name in DATA if one[name].tobytes() != two[name].tobytes()]
    if found:
        return found
    for k in range(one.steps):
        step = one.step_data(k)
        ends = [exact_step(step, np.flatnonzero(run["lam"][k] > 0).tolist()) for run in (one, two)]
        for name in ("delta_q", "net", "slack"):
            bits = {getattr(end, name).tobytes() for end in ends}
            if len(bits) > 1:
                found.append(f"{name} of step {k}")
    return found


def main() -> int:
    """Compare all runs with the plain path's."""
    settings = [f"steps={sys.argv[1]}"] if len(sys.argv) > 1 else []
    failed = False
    for case, own in CASES.items():
        truth = load_scenario("bunny_grasp", [*own, *settings]).run(False)
        for backend in installed("native"):
            solver = f"solver.backend={backend}"
            run = load_scenario("bunny_grasp", [*own, *settings, solver], fast=True).run(False)
            found = differences(truth, run)
            said = f"differs in {', '.join(found[:5])}" if found else "equal bits"
            kinds = sorted(set(run["certificate"].tolist()))
            print(f"{case}: {backend}, fast, {run.steps} steps, {kinds}: {said}", flush=True)
            failed |= bool(found)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
