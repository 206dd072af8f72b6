"""A held mug, in MuJoCo and in the exact answer: what contacts bear, how fast bodies move."""

from pathlib import Path

import mujoco
import numpy as np

import quasistatic_ref as qr
from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref.optional.show.figures import Figure, panels

SCENE = Path(__file__).parents[1] / "examples" / "opinion" / "mug.xml"


def figure() -> Figure:
    """Bars of both answers at the keyframe ``grip``."""
    model = mujoco.MjModel.from_xml_path(str(SCENE))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    opinion = qr.mujoco_opinion(model, data)
    forces = {c.name: (c.theirs.normal, c.exact.normal) for c in opinion.contacts}
    speeds = {b.name: (1e3 * b.fastest(b.theirs), 1e3 * b.fastest(b.exact)) for b in opinion.bodies}
    page, both = panels(6.3, 2.4, columns=2)
    quantities = ((forces, "normal force [N]"), (speeds, "speed of the body [mm/s]"))
    for axes, (bars, words) in zip(both, quantities, strict=True):
        at = np.arange(len(bars))
        theirs, exact = np.array(list(bars.values())).T
        axes.barh(at - 0.2, theirs, 0.36, color="0.3", label="MuJoCo")
        axes.barh(
            at + 0.2, exact, 0.36, color="white", edgecolor="black", hatch="//", label="exact"
        )
        axes.set_yticks(at, list(bars))
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        label_axes(axes, words, key=False)
    legend_below(list(both), both[0].get_legend_handles_labels()[0])
    return page
