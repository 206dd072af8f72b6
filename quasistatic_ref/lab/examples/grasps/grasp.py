"""After Figure 1 of the paper: a 992-point bunny, here held behind its centre of mass and lifted.

The only difference between the rows is mu_omega of the fingers. Without it, nothing resists turning
about the points by which the two fingers hold it, and the bunny hangs down.
"""

from collections.abc import Sequence
from typing import Any

from quasistatic_ref.lab.cached_runs import grasp, lift
from quasistatic_ref.lab.clouds.rows import rotations_by_case
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.grasp import grasp_strip
from quasistatic_ref.lab.grasp import CASES, INSTANTS, rotations
from quasistatic_ref.optional.show.figures import Figure


def main() -> Numbers:
    """How high the bunny was lifted, how far it turned, and the shape of the problem of a step."""
    found: Numbers = {}
    angles = rotations(grasp("with torsion")[0], {case: grasp(case)[1] for case in CASES})["angles"]
    for case in CASES:
        motion, steps = lift(case)
        run = grasp(case)[1]
        found[f"lift {case} [mm]"] = 1e3 * (motion.t[steps][-1, 2] - motion.t[steps][0, 2])
        found[f"rotation {case} [deg]"] = float(angles[case].max())
        found[f"steps certified exactly {case} [-]"] = float(sum(run["certificate"] == "exact"))
    rows, variables = run["A"].shape[1:]
    return found | {"variables of a step [-]": variables, "rows of a step [-]": rows}


def figure(ax: Any = None, *, instants: Sequence[float] = INSTANTS) -> Figure:
    """Instants in columns, with and without torsion in rows.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    instants : sequence of float
        [s].
    """
    runs = {case: grasp(case)[1] for case in CASES}
    return grasp_strip(grasp("with torsion")[0], runs, instants, rotations_by_case(), ax)
