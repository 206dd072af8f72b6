"""A load in the friction cone of its contact."""

from itertools import combinations
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from numpy.typing import ArrayLike
from scipy.spatial import ConvexHull

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.optional.show.figures.looks import (
    CONE_EDGE,
    CONE_FACE,
    FORCE,
    ROUND,
    force_arrow,
)
from quasistatic_ref.optional.show.figures.style import legend_above
from quasistatic_ref.step.cones import cone

FAINT: Final = 0.5
"""Opacity of a cone, in which a load is seen [-]."""


def cone_with_load(
    axes: Axes, wrench: ArrayLike, mu_v: float, mu_omega: float, *, cone: str = "pyramid"
) -> None:
    """Draw the friction that a contact can bear at its normal force, and the friction it bears.

    The dashed outline is the limit without torque about n. A torque shrinks it to the filled area.

    Parameters
    ----------
    axes : Axes
    wrench : array_like, shape (4,)
        (f_d1, f_d2, f_n, tau_n) [N, N m].
    mu_v, mu_omega : float
        [-], positive; [m].
    cone : str
        Its name, such as ``"pyramid"``, ``"ellipsoid"`` or ``"product"``.

    Raises
    ------
    InputError
        If there is no normal force, or mu_v is not positive.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> qr.figures.cone_with_load(axes, [0.2, 0.1, 1.0, 0.0], mu_v=0.5, mu_omega=0.01)
    >>> axes.get_xlim()[1]
    np.float64(0.575)
    """
    f_1, f_2, f_n, torque = np.asarray(wrench, dtype=np.float64)
    if not (f_n > 0 and mu_v > 0):
        raise InputError("needs a normal force and mu_v > 0", field="wrench", value=wrench)
    share = torque / (mu_omega * f_n) if mu_omega > 0 else 0.0
    axes.add_patch(Polygon(
        mu_v * f_n * limit_at(cone, 0.0), fill=False, edgecolor=CONE_EDGE, linestyle="--",
    ))  # fmt: skip
    left = limit_at(cone, min(abs(share), 1.0))
    if len(left):
        axes.add_patch(Polygon(
            mu_v * f_n * left, facecolor=CONE_FACE, edgecolor=CONE_EDGE, alpha=FAINT,
        ))  # fmt: skip
    force_arrow(axes, (0.0, 0.0), (f_1, f_2))
    reach = 1.15 * max(mu_v * f_n, abs(f_1), abs(f_2))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel=r"$f_{d_1}$ [N]", ylabel=r"$f_{d_2}$ [N]")
    with_torque = rf"limit, $\tau_n$ = {torque:.3g} N m"
    handles = [
        Line2D([], [], color=CONE_EDGE, linestyle="--", label=r"limit, $\tau_n = 0$"),
        Patch(facecolor=CONE_FACE, edgecolor=CONE_EDGE, alpha=FAINT, label=with_torque),
        Line2D([], [], color=FORCE, label=f"load at $f_n$ = {f_n:.3g} N"),
    ]
    legend_above(axes, handles)


def limit_at(name: str, share: float) -> Array:
    """Corners of (f_1, f_2) / (mu_v f_n) that a cone allows where |tau_n| = share mu_omega f_n.

    Parameters
    ----------
    name : str
        Of the cone.
    share : float
        From 0 to 1 [-].

    Returns
    -------
    ndarray, shape (N, 2)
        In order around; no rows where no more than a point is left.
    """
    if not cone(name).polyhedral:  # the ellipsoid's is a circle
        angle = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.asarray(np.sqrt(1 - share**2) * circle)
    corners = cone_matrix(name)[:, 1:]
    section = [corner[:2] for corner in corners if corner[2] == share]
    for one, other in combinations(corners, 2):
        if (one[2] - share) * (other[2] - share) < 0:
            way = (share - one[2]) / (other[2] - one[2])
            section.append((1 - way) * one[:2] + way * other[:2])
    points = np.array(section)
    if len(points) < 3 or not np.ptp(points, axis=0).all():
        return np.zeros((0, 2))
    return np.asarray(points[ConvexHull(points).vertices])
