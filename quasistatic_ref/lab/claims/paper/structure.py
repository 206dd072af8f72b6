"""The size of the bunny's quadratic program: 13 x 80."""

import numpy as np

from quasistatic_ref.lab.cached_runs import grasp
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.shapes.placed_shape import PointCloud


def evidence() -> Evidence:
    """Numbers that the paper gives, from the scenario and its run."""
    scenario, run = grasp("with torsion")
    sizes = {
        len(p.beta.shape.points) for p in scenario.pairs if isinstance(p.beta.shape, PointCloud)
    }
    torsional = run["rows"] == 6
    numbers = {
        "points of the cloud": (max(sizes), 992),
        "signed distances of a step ('almost 3,000')": (max(sizes) * len(scenario.pairs), 2976),
        "objects": (len(scenario.pairs), 3),
        "points of each object": (max(pair.k for pair in scenario.pairs), 5),
        "primal variables": (run["A"].shape[2], 13),
        "rows": (run["A"].shape[1], 80),
        "contacts with torsion": (int(torsional.sum()), 10),
        "contacts without": (int((~torsional).sum()), 5),
        "h [s]": (scenario.h, 0.01),
    }
    return Evidence.of(*(comparison(what, np.array(m), e, 0.0) for what, (m, e) in numbers.items()))


CLAIM = Claim(
    name="structure",
    sentence="The grasp's quadratic program has 13 variables and 80 rows in every step: 10 "
    "contacts of the gripper with torsion, 5 of the floor without.",
    where="the paper, section III-B; how 13 and 80 come about is an inference, and that the floor "
    "goes without torsion departs from its words (docs/theory/errata.md)",
    sweep="bunny_grasp, 300 steps",
    reason="Whole numbers, and h as it is written.",
    measure=evidence,
)
