"""The two points at which the fingers hold the bunny, their line, and the arm of its weight.

From the forces of a step of the lift: at each finger one point bears load.
"""

from typing import NamedTuple

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import load_scenario
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

HELD = 137  # a step of the lift
LOADED = 1e-6  # N
BEHIND = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.0}


class Grip(NamedTuple):
    """Where the bunny is held, in the world [mm]."""

    cloud: Array
    """(P, 3)."""
    held: Array
    """Of the loaded points, (2, 3)."""
    centre: Array
    """Of mass, (3,)."""

    @property
    def foot(self) -> Array:
        """The point of the line through both points that is nearest to the centre of mass, (3,)."""
        one, other = self.held
        along = (other - one) / np.linalg.norm(other - one)
        return one + ((self.centre - one) @ along) * along


def grip() -> Grip:
    """The grip at the start of that step."""
    scenario = load_scenario("bunny_grasp", steps=HELD + 1)
    run = scenario.run(progress=False, findings=False)
    links = scenario.system.at(run.q[HELD]).kinematics
    bunny = scenario.system.link("bunny")
    R, t = links.R[bunny], links.t[bunny]
    cloud = scenario.pairs[-1].beta.shape.points
    loaded = (run["rows"] == 6) & (np.abs(run.step_forces(HELD)[:, 2]) > LOADED)
    held = run["beta"][HELD][loaded]
    assert len(held) == 2
    centre = R @ scenario.system.centres[bunny] + t
    return Grip(1e3 * (cloud @ R.T + t), 1e3 * held, 1e3 * centre)


def figure() -> Figure:
    """Left from above: both points, their line, the arm. Right along the line: weight and arm."""
    here = grip()
    page, (above, along) = panels(6.3, 3.2, columns=2)
    arm = np.linalg.norm((here.centre - here.foot)[:2])
    for axes, (i, j) in ((above, (1, 0)), (along, (0, 2))):
        axes.plot(*here.cloud[:, [i, j]].T, ".", color="0.75", markersize=scaled(2), zorder=0)
        axes.plot(*np.array([here.foot, here.centre])[:, [i, j]].T, color="#D55E00", linestyle="-")
        axes.plot(*here.centre[[i, j]], "ko", markersize=scaled(5), label="centre of mass")
        axes.plot(
            *here.held[:, [i, j]].T, "s", color="#0072B2", markersize=scaled(5),
            label="points that the fingers hold",
        )  # fmt: skip
        axes.set(aspect="equal")
    one, other = here.held
    ends = np.array([one + 0.25 * (one - other), other + 0.25 * (other - one)])
    above.plot(*ends[:, [1, 0]].T, color="#0072B2", linestyle="--", label="line through both")
    above.text(
        here.centre[1] - 5, here.centre[0] - 4, f"arm {arm:.0f} mm",
        color="#D55E00", ha="center", va="top", bbox=BEHIND,
    )  # fmt: skip
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2)}
    weight = here.centre[[0, 2]]
    along.annotate("", weight - [0, 45], weight, arrowprops=look | {"color": "0.2"})
    along.text(weight[0] - 5, weight[1] - 30, "m g", ha="right", bbox=BEHIND)
    label_axes(above, "y [mm]", "x [mm]", "from above", key=False)
    label_axes(along, "x [mm]", "z [mm]", "along the line", key=False)
    legend_below([above, along], above.get_legend_handles_labels()[0])
    return page
