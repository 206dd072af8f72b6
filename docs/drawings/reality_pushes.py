"""Which cone is real? Measured pushes of a real object, predicted in two friction cones.

A finger pushes an object over a surface by some centimetres. Where the object was before and after
was measured (MIT push data); mu_omega / mu_v of its support was identified from measured loads, not
from these pushes. Change the cone, the pair or the number of pushes, and see what becomes of them.
"""

from collections.abc import Sequence

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref.lab.reality.errors import pose_errors
from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.measurements import (
    Pair,
    Pushes,
    loads_read,
    pairs_read,
    pushes_read,
)
from quasistatic_ref.lab.reality.predict import prediction
from quasistatic_ref.lab.reality.push import pushed_scene
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels

PAIR = "abs/rect1"
CONES = ("ellipsoid", "pyramid")
EVERY, SHOWN, ADVANCE = 26, 6, 2e-3
"""Of the pushes of the pair; of these, how many are drawn; the finger's way in a step [m]."""


def measurements(name: str = PAIR) -> tuple[Pair, float, Pushes]:
    """A pair, its mu_omega / mu_v [m] from loads, and some of its pushes."""
    (pair,) = pairs_read([name])
    ratio = identified_ratio(loads_read([pair])[name], pair.outline.gyration)
    return pair, ratio, pushes_read([pair])[name].every(EVERY)


def poses(pair: Pair, ratio: float, pushes: Pushes, cone: str) -> Array:
    """Predicted poses after pushes with that `ratio` [m], shape (n, 3) [m, rad]."""
    scene = pushed_scene(Settings(cone=cone, advance=ADVANCE), pair, ratio)
    ways = zip(pushes.before, pushes.path, strict=True)
    return np.array([prediction(scene, before, path, "off").pose for before, path in ways])


def figure(*, pair: str = PAIR, cones: Sequence[str] = CONES) -> Figure:
    """Some pushes from above: outlines as measured in grey, as predicted in lines.

    Parameters
    ----------
    pair : str
        surface/shape.
    cones : sequence of str
        One or two.
    """
    page, axes = panels(6.3, 4.6, columns=3, rows=2, sharex=True, sharey=True)
    own, ratio, pushes = measurements(pair)
    ends = {cone: poses(own, ratio, pushes, cone) for cone in cones}
    moved = pose_errors(pushes.before, pushes.after)[:, 0]
    chosen = np.sort(np.argsort(-moved, kind="stable")[:SHOWN])
    for k, one in zip(chosen, axes, strict=False):
        origin = pushes.before[k]
        drawn = own.outline.line_at
        one.plot(*drawn(origin, origin), color="0.6", linewidth=0.8, linestyle=":", label="before")
        one.fill(*drawn(pushes.after[k], origin), color="0.85", label="after, measured")
        for cone, style in zip(cones, ("-", "--"), strict=False):
            end = drawn(ends[cone][k], origin)
            one.plot(*end, color="black", linewidth=0.9, linestyle=style, label=f"after, {cone}")
        path = 1e3 * (pushes.path[k] - origin[:2])
        one.annotate("", path[1], xytext=path[0], arrowprops={"arrowstyle": "->"})
        one.set_aspect("equal")
        label_axes(one, "x [mm]", "y [mm]", key=False)
        one.label_outer()
    legend_below(axes, axes[0].get_legend_handles_labels()[0])
    return page
