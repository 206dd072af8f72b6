"""The friction cones: their limit surfaces, and what they make of a pinch."""

from __future__ import annotations

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from quasistatic_ref.figures.style import figure_style, scaled, sized
from quasistatic_ref.figures.surfaces import faces
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.data import Contacts, StepData
from quasistatic_ref.step.friction import cone_matrix

SHOWN = (PYRAMID, ELLIPSOID, "product")
COLOURS = {PYRAMID: "tab:blue", ELLIPSOID: "tab:orange", "product": "tab:green"}
GRAVITY = 9.81
STILL = 1e-12
"""Slip below this [m, rad] is none: answers are exact, or enclosed to 1e-18 of a millimetre."""


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
                axes.plot_surface(
                    *ball, color=COLOURS[name], alpha=0.5, edgecolor="k", linewidth=0.15
                )
            else:
                axes.add_collection3d(
                    Poly3DCollection(
                        faces(cone_matrix(name)[:, 1:]),
                        facecolor=COLOURS[name],
                        edgecolor="k",
                        linewidth=0.6,
                        alpha=0.5,
                    )
                )
            axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), zlim=(-1.3, 1.3), box_aspect=(1, 1, 1))
            axes.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1), zticks=(-1, 0, 1))
            axes.set_xlabel(r"$f_1/\mu_v$ [N]", labelpad=pad)
            axes.set_ylabel(r"$f_2/\mu_v$ [N]", labelpad=pad)
            axes.set_zlabel(r"$\tau_n/\mu_\omega$ [N]", labelpad=pad - 2)
            axes.tick_params(labelsize="small", pad=-3)
            axes.set_title(name)
        figure.subplots_adjust(left=0.0, right=0.95, bottom=0.06, top=0.92, wspace=0.12)
    return figure


def pinch_thresholds(
    mass: float = 0.2, mu_v: float = 0.5, mu_omega: float = 0.02, offsets: int = 13
) -> Figure:
    """The least squeeze that holds a bar off its axis: closed forms, and steps that slip or hold.

    Parameters
    ----------
    mass : float
        [kg].
    mu_v, mu_omega : float
        [-], [m].
    offsets : int
        Number of distances d of the centre of mass from the axis of the fingers.
    """
    d = np.linspace(0.0, 0.06, offsets)
    slide, spin = mass * GRAVITY / (2 * mu_v), mass * GRAVITY * d / (2 * mu_omega)
    least = {
        PYRAMID: slide + spin,  # (R21)
        ELLIPSOID: np.hypot(slide, spin),  # (R22)
        "product": np.maximum(slide, spin),  # (R23)
    }
    with figure_style():
        figure, axes = plt.subplots(figsize=sized(4.8, 3.4))
        for name in SHOWN:
            axes.plot(1e3 * d, least[name], color=COLOURS[name], label=name)
            for share, marker, fill in ((0.97, "v", "none"), (1.03, "^", COLOURS[name])):
                slips = [
                    _slip(bar_step(mass, float(n), float(x), mu_v, mu_omega, name)) > STILL
                    for n, x in zip(share * least[name], d, strict=True)
                ]
                right = np.array(slips) == (share < 1)
                axes.plot(
                    1e3 * d[right],
                    share * least[name][right],
                    marker,
                    markersize=scaled(4),
                    color="black",
                    markeredgewidth=0.6,
                    markerfacecolor=fill,
                    linestyle="none",
                )
        axes.set_xlabel("distance d of the centre of mass from the fingers' axis [mm]")
        axes.set_ylabel("squeeze N [N]")
        axes.set_title("lines: (R21)-(R23); open: a step slips, filled: it holds", loc="left")
        axes.legend(loc="upper left", title="cone")
    return figure


def bar_step(
    mass: float, grip: float, d: float, mu_v: float, mu_omega: float, name: str = PYRAMID
) -> StepData:
    """A bar between two fingers on the axis x, its centre of mass a distance d off along y.

    The fingers are rigid but for the squeeze; gravity is along d1 of both contacts.

    Parameters
    ----------
    mass : float
        [kg].
    grip : float
        Force that each finger presses with [N].
    d : float
        [m].
    mu_v, mu_omega : float
        [-], [m].
    name : str
        The cone.
    """
    stiffness, half_width = 1000.0, 0.03
    n = np.array([[1.0, 0, 0], [-1.0, 0, 0]])
    d1 = np.array([[0.0, 0, 1], [0.0, 0, 1]])
    J = np.zeros((2, 4, 8))
    for j in range(2):
        x, y, z = -half_width * n[j, 0], d, 0.0
        J[j, :3, j] = -n[j]
        J[j, :3, 2:5] = np.eye(3)
        J[j, :3, 5:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]  # omega x r
        J[j, 3, 5:] = n[j]
    return StepData(
        h=0.01,
        K_q=stiffness * np.eye(2),
        M_u=np.diag([mass, mass, mass, 1e-4, 1e-4, 1e-4]),
        tau_a=np.zeros(2),
        tau_u=np.array([0.0, 0.0, -GRAVITY * mass, 0.0, 0.0, 0.0]),
        delta_q_bar_a=np.full(2, grip / stiffness),
        contacts=Contacts(
            name=("left", "right"),
            phi=np.zeros(2),
            n=n,
            d1=d1,
            d2=np.cross(n, d1),
            J=J,
            mu_v=np.full(2, mu_v),
            mu_omega=np.full(2, mu_omega),
            rows=np.array([6, 6]),
        ),
        cone=name,
    )


def _slip(step: StepData) -> float:
    """Largest motion of the bar relative to a finger, along the tangents and about the normal."""
    motion = step.contacts.J @ solve_step(step).delta_q
    along = [
        np.einsum("ci,ci->c", axis, motion[:, :3]) for axis in (step.contacts.d1, step.contacts.d2)
    ]
    return float(np.abs(np.concatenate([*along, motion[:, 3]])).max())
