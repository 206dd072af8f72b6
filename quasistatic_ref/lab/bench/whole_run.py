"""What a user waits for: a whole run of the grasp by the wall, next to the sum of its stages."""

import time

from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.backends import CERTIFY

WALL = "a whole run, by the wall"


def whole_run(steps: int, repeat: int) -> dict[str, float]:
    """Wall time of a run and the stages that it tells of, a step [us]: the least of `repeat` runs.

    Parameters
    ----------
    steps : int
        Of each run, whose record is light. Its scene is loaded before; its findings are included.
    repeat : int
    """
    found = dict[str, float]()
    settings = [f"steps={steps}", "record=light", "solver.backend=daqp"]
    for words, certify in (("", "off"), (", proved", CERTIFY[0])):
        scenario = load_scenario("bunny_grasp", [*settings, f"solver.certify={certify}"], fast=True)
        wall = list[float]()
        stages = list[float]()
        for _ in range(repeat):
            start = time.perf_counter()
            run = scenario.run(progress=False)
            len(run.findings)
            wall.append(time.perf_counter() - start)
            stages.append(sum(float(each.sum()) for each in run.seconds.values()))
        found[WALL + words] = 1e6 * min(wall) / run.steps
        found[f"the stages of its steps{words}"] = 1e6 * min(stages) / run.steps
    return found
