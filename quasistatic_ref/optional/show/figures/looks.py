"""The look of every picture of a scene: its camera, and a colour for each role.

The colours are those of Okabe and Ito (2008), which colour-blind readers can distinguish. Robots
are grey: what is coloured is what they act on, and the forces on it.
"""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patheffects import withStroke

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.style import scaled

if TYPE_CHECKING:
    from quasistatic_ref.model.system import System

Place = tuple[float, float]
ROUND: Final = 48
"""Corners of a circle, as drawn."""

CAMERA: Final = Camera(azimuth=-62, elevation=16)

OBJECTS: Final = ("#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#F0E442")
"""Bodies without actuators, in turn."""
ROBOTS: Final = ("#A0A0A0", "#B59A74", "#8296AB")
"""Bodies with actuators, in turn."""
FIXED: Final = "#BDBDBD"
"""What belongs to no body."""
FLOOR: Final = "#EDEDED"
"""Half-spaces."""
OPACITY: Final = {FIXED: 0.5, FLOOR: 0.8}
"""Of solids of a colour, if not 1 [-]: through what is fixed, what it hides is seen."""
FORCE: Final = "#D55E00"
STATES: Final = {"sticking": "#000000", "sliding": FORCE, "apart": "#909090"}
"""Contacts, and their forces where states are shown."""
CONE_FACE: Final = "#E69F00"
CONE_EDGE: Final = "#8A5F00"

FARTHEST: Final = 0.25
"""Share of a cloud's colour in its farthest point; the rest is white [-]."""
SHADE: Final = 0.45
"""Brightness of a face that is turned away from the light; that of one towards it is 1 [-]."""
LIGHT: Final = np.array([-0.35, 0.6, 0.72])
"""Where light comes from, in the axes of the camera: right, up, near [-]."""


def force_arrow(axes: Axes, start: Place, end: Place) -> None:
    """An arrow with a white edge, which is seen in grey too; its head keeps its size.

    Parameters
    ----------
    axes : Axes
    start, end : (float, float)
        Its tail and its head [of the axes].
    """
    axes.annotate(
        "", end, xytext=start, annotation_clip=False, zorder=8,
        arrowprops={"arrowstyle": "-|>", "color": FORCE, "linewidth": scaled(1.6),
                    "shrinkA": 0, "shrinkB": 0, "mutation_scale": scaled(6.5),
                    "path_effects": [withStroke(linewidth=scaled(3.2), foreground="white")]},
    )  # fmt: skip


def body_colours(system: System) -> dict[str, str]:
    """A colour for each body, by its name."""
    moved = {joint.name.partition("/")[0] for joint in system.joints if joint.actuated}
    robots = cycle(ROBOTS)
    objects = cycle(OBJECTS)
    return {body.name: next(robots if body.name in moved else objects) for body in system.bodies}


def link_colours(system: System) -> dict[int, str]:
    """The colour of its body for each link, by the number of the link."""
    colours = body_colours(system)
    bodies = [name.partition("/")[0] for name in system.links]
    return {i: colours.get(body, FIXED) for i, body in enumerate(bodies)}


def by_depth(colour: str, depth: Array) -> Array:
    """Red, green and blue of points: the paler the farther away.

    Parameters
    ----------
    colour : str
        Of the nearest point.
    depth : ndarray, shape (N,)
        Nearness to the camera [m].

    Returns
    -------
    ndarray, shape (N, 3)
        From 0 to 1 [-].
    """
    near = (depth - depth.min()) / max(float(np.ptp(depth)), 1e-12)
    share = FARTHEST + (1 - FARTHEST) * near[:, None]
    return np.asarray(share * to_rgb(colour) + (1 - share))


def lit(colour: str, normals: Array) -> Array:
    """Red, green and blue of faces: the brighter the more they are turned to the light.

    Parameters
    ----------
    colour : str
    normals : ndarray, shape (N, 3)
        In the axes of the camera [-].

    Returns
    -------
    ndarray, shape (N, 3)
        From 0 to 1 [-].
    """
    share = SHADE + (1 - SHADE) * np.clip(normals @ LIGHT, 0, 1)[:, None]
    return np.asarray(share * to_rgb(colour))
