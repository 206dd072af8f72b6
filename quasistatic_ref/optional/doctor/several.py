"""Steps under Coulomb's law that are one of several solutions."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.between import COULOMB_COUNT, Said
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.step.cones import cone

LOOKED = 5
"""Steps of a run of which all solutions are searched."""
SYSTEMS = 100
"""Systems of inequalities that a search may take: a second at most, where contacts are many."""


def several(run: Run) -> Iterator[Said]:
    """Steps with several solutions, among a few that are spread over the run.

    The search ends at the first step of which it is not known.
    """
    simulator = run.simulator
    posed = run.small and simulator.extension is None and cone(simulator.cone).polyhedral
    if simulator.law != COULOMB or not posed:
        return
    count = COULOMB_COUNT.found()
    if count is None:
        return
    steps = np.unique(np.linspace(0, run.steps - 1, LOOKED).round().astype(int)).tolist()
    found = []
    for k in steps:
        solutions = count(run.step_data(k), SYSTEMS)
        if solutions == "unknown":
            break
        if solutions == "several":
            found.append(k)
    if found:
        yield Said(
            'do not rely on which solution was taken, or take law = "convex", which has one',
            f"{len(found)} of {len(steps)} steps that were looked at have several solutions under "
            f"Coulomb's law, the first of them step {found[0]}",
            {"several": len(found), "step": found[0]},
        )
