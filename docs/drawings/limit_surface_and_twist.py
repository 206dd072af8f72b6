"""The limit surface of a slider in the ellipsoid: each twist is normal to it at its load.

A disk lies on a table in one contact with torsional friction and is pulled, along d1 and about n,
a little harder than the contact can bear. Its slip and spin are drawn where its load meets the
surface.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from docs.drawings.labels import label_axes
from quasistatic_ref import solve_step
from quasistatic_ref.lab.made_steps.rigid import rigid_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

M, GRAVITY, MU_V, CHI = 0.5, 9.81, 0.4, 0.03  # kg, m/s^2, -, m: CHI is mu_omega / mu_v
LIMIT = MU_V * M * GRAVITY  # N
ANGLES = np.radians([0, 20, 40, 60, 80, 90])
"""Of the load, between a pure force and a pure torque, in units of the half axes."""


def twist(load: np.ndarray, rho: float = CHI, cone: str = "ellipsoid") -> np.ndarray:
    """(s_1, CHI omega) [m], shape (2,), of a step under a load (f_1, tau / CHI) in units of LIMIT.

    With the radius of gyration `rho` = CHI [m] the disk's inertia does not turn the twist.
    """
    force, torque = LIMIT * load
    wrench = (force, 0.0, -M * GRAVITY, 0.0, 0.0, CHI * torque)
    step = rigid_step(
        M, M * rho**2, wrench, [[0.0, 0.0, 0.0]], [np.eye(3)],
        mu_v=MU_V, mu_omega=MU_V * CHI, rows=6,
    ).replace(cone=cone)  # fmt: skip
    delta_q = solve_step(step).delta_q
    return np.array([delta_q[0], CHI * delta_q[5]])


def main() -> tuple[np.ndarray, np.ndarray]:
    """Loads (f_1, tau / CHI) on the surface [N], twists (s_1, CHI omega) [m], (angles, 2) each."""
    loads = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])
    return LIMIT * loads, np.array([twist(1.05 * load) for load in loads])


def figure() -> Figure:
    """A quarter of the surface in the ellipsoid; the octahedron, whose face has one twist."""
    page, (axes, flat) = panels(6.3, 3.4, columns=2, sharey=True, width_ratios=[1.4, 1])
    turn = np.linspace(0, np.pi / 2, 100)
    loads, twists = main()
    for (force, torque), (slip, spin) in zip(loads, twists, strict=True):
        # The normal of f_1^2 + (tau / CHI)^2 = LIMIT^2 is (f_1, tau / CHI^2): s_1 : omega (R28).
        assert abs(slip * torque - spin * force) < 1e-6 * np.hypot(slip, spin) * LIMIT
    _draw(axes, np.cos(turn), np.sin(turn), loads, twists)
    share = np.linspace(0, 1, 100)
    between = np.array([0.25, 0.5, 0.75])
    on_face = LIMIT * np.column_stack([between, 1 - between])
    moved = np.array([twist(1.05 * load / LIMIT, cone="pyramid") for load in on_face])
    assert np.allclose(moved[:, 0], moved[:, 1], rtol=1e-9)
    _draw(flat, 1 - share, share, on_face, moved)
    axes.text(0.75, 22, "what the contact bears", ha="center")
    axes.set(xlim=(0, 2.7), ylim=(0, 81))
    flat.set(xlim=(0, 2.7))
    label = "friction force $f_1$ [N]"
    label_axes(axes, label, r"torque about the normal $\tau_n$ [N mm]", "ellipsoid", key=False)
    label_axes(flat, label, "", "octahedron", key=False)
    page.legend(
        [Line2D([], [], color="#D55E00", linestyle="-", linewidth=scaled(1.8))],
        ["slip and spin, in the scales of the axes"], loc="outside lower center",
    )  # fmt: skip
    return page


def _draw(
    axes: Axes, f: np.ndarray, tau: np.ndarray, loads: np.ndarray, twists: np.ndarray
) -> None:
    """A surface, by f_1 and tau / CHI in units of LIMIT, with a twist at each load."""
    axes.plot(LIMIT * f, LIMIT * CHI * 1e3 * tau, color="0.6", linestyle="-", linewidth=scaled(3))
    axes.fill_between(LIMIT * f, LIMIT * CHI * 1e3 * tau, color="0.93")
    for (force, torque), (slip, spin) in zip(loads, twists, strict=True):
        length = 0.5 / np.hypot(slip, spin)
        start = np.array([force, 1e3 * CHI * torque])
        tip = start + length * np.array([slip, 1e3 * CHI * spin])
        look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "color": "#D55E00"}
        axes.annotate("", tip, start, arrowprops=look | {"linewidth": scaled(1.8)})
        axes.plot(*start, "o", color="#0072B2", markersize=scaled(5))
