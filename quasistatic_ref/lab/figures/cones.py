"""The friction cones: their limit surfaces, and what they make of a pinch."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from quasistatic_ref.figures.style import figure_style, scaled, sized
from quasistatic_ref.figures.surfaces import faces
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.step.friction import cone_matrix

SHOWN = (PYRAMID, ELLIPSOID, "product")
SURFACE: Final[dict[str, Any]] = {"alpha": 0.5, "edgecolor": "k"}
COLOURS = {PYRAMID: "tab:blue", ELLIPSOID: "tab:orange", "product": "tab:green"}


def limit_surfaces() -> Figure:
    """The forces that a contact can bear at f_n = 1, in units of mu_v, mu_v, mu_omega."""
    with figure_style():
        figure = plt.figure(figsize=sized(6.3, 2.9))
        pad = -6 + 10 * (scaled(1) - 1)  # larger figures have larger numbers beside the axes
        for k, name in enumerate(SHOWN):
            axes = figure.add_subplot(1, 3, k + 1, projection="3d")
            if name == ELLIPSOID:
                u, v = np.mgrid[0 : 2 * np.pi : 33j, 0 : np.pi : 17j]
                ball = np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)
                axes.plot_surface(*ball, color=COLOURS[name], linewidth=0.15, **SURFACE)
            else:
                sides, style = faces(cone_matrix(name)[:, 1:]), SURFACE | {"linewidth": 0.6}
                axes.add_collection3d(Poly3DCollection(sides, facecolor=COLOURS[name], **style))
            for axis in "xyz":
                axes.set(**{f"{axis}lim": (-1.3, 1.3), f"{axis}ticks": (-1, 0, 1)})
            axes.set_box_aspect((1, 1, 1))
            axes.set_xlabel(r"$f_1/\mu_v$ [N]", labelpad=pad)
            axes.set_ylabel(r"$f_2/\mu_v$ [N]", labelpad=pad)
            axes.set_zlabel(r"$\tau_n/\mu_\omega$ [N]", labelpad=pad - 2)
            axes.tick_params(labelsize="small", pad=-3)
            axes.set_title(name)
        figure.subplots_adjust(left=0.0, right=0.95, bottom=0.06, top=0.92, wspace=0.12)
    return figure


def pinch_thresholds(
    d: Array, least: Mapping[str, Array], slips: Mapping[str, Mapping[float, Mask]]
) -> Figure:
    """The least squeeze that holds a bar off its axis: closed forms, and steps that slip or hold.

    Parameters
    ----------
    d : ndarray, shape (N,)
        Distances of the centre of mass from the axis of the fingers [m].
    least : mapping of str to ndarray, shape (N,)
        Cone -> the least squeeze in closed form [N].
    slips : mapping of str to mapping of float to ndarray, shape (N,)
        Cone -> share of the least squeeze -> whether a step slips [-]. A step is marked where it
        does what the closed form says.
    """
    with figure_style():
        figure, axes = plt.subplots(figsize=sized(4.8, 3.4))
        for name in SHOWN:
            axes.plot(1e3 * d, least[name], color=COLOURS[name], label=name)
            for share, slipped in slips[name].items():
                right = slipped == (share < 1)
                mark, face = ("v", "none") if share < 1 else ("^", COLOURS[name])
                style: dict[str, Any] = {"markerfacecolor": face, "markeredgewidth": 0.6}
                style |= {"color": "black", "linestyle": "none", "markersize": scaled(4)}
                axes.plot(1e3 * d[right], share * least[name][right], mark, **style)
        distance = "distance d of the centre of mass from the fingers' axis [mm]"
        axes.set(xlabel=distance, ylabel="squeeze N [N]")
        axes.set_title("lines: (R21)-(R23); open: a step slips, filled: it holds", loc="left")
        axes.legend(loc="upper left", title="cone")
    return figure
