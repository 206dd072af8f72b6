"""The friction of a patch that slides and turns, point by point, and as one force and one torque.

Each part of the patch has the same load and resists its own slip, by Coulomb's law.
"""

import numpy as np
from matplotlib.patches import Arc, Circle

from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

RADIUS, RESTS = 30.0, 18.0  # mm: of the patch; from its centre to the point that rests
RINGS = 5


def main() -> tuple[np.ndarray, np.ndarray]:
    """Points of equal area, and the friction at each over its limit; (n, 2) [mm] and [-]."""
    rings = [
        (RADIUS * (k + 0.5) / RINGS, np.arange(count := 6 * k + 3) * 2 * np.pi / count)
        for k in range(RINGS)
    ]
    points = np.concatenate([r * np.column_stack([np.cos(a), np.sin(a)]) for r, a in rings])
    slip = np.column_stack([-points[:, 1], points[:, 0] + RESTS])  # it turns about (-RESTS, 0)
    return points, -slip / np.linalg.norm(slip, axis=1, keepdims=True)


def figure() -> Figure:
    """Left the points, right the sums of their forces and of their torques about the centre."""
    page, (left, right) = panels(6.3, 2.8, columns=2)
    points, friction = main()
    force = friction.mean(axis=0)
    lever = (points[:, 0] * friction[:, 1] - points[:, 1] * friction[:, 0]).mean()
    assert abs(force[0]) < 0.02  # by symmetry, but for the places of the points
    assert force[1] < 0
    assert lever < 0
    # Near the ellipsoid of an even pressure, whose mu_omega is 2/3 mu_v times the radius, (R15).
    assert 0.9 < np.hypot(force[1], lever / (2 * RADIUS / 3)) < 1.1
    left.quiver(*points.T, *friction.T, color="#D55E00", angles="xy", scale_units="xy", scale=0.16,
                width=0.006)  # fmt: skip
    left.plot(*points.T, "o", color="0.3", markersize=scaled(2))
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2)}
    right.annotate("", (0, 40 * force[1]), (0, 0), arrowprops=look | {"color": "#D55E00"})
    right.text(2.5, 30 * force[1], "force")
    right.add_patch(
        Arc((0, 0), 24, 24, theta1=-60, theta2=150, color="#0072B2", linewidth=scaled(2))
    )
    end = 12 * np.array([np.cos(np.radians(-60)), np.sin(np.radians(-60))])
    right.annotate("", end - np.array([2.6, 1.5]), end, arrowprops=look | {"color": "#0072B2"})
    right.text(-11, 15, r"torque $\tau_n$")
    right.plot(0, 0, "o", color="0.3", markersize=scaled(4))
    for axes, title in ((left, "many points that slide"), (right, "one contact")):
        axes.add_patch(Circle((0, 0), RADIUS, facecolor="#BBD6EA", edgecolor="0.4", zorder=0))
        axes.set(xlim=(-36, 36), ylim=(-36, 36), aspect="equal", title=title)
        axes.set_axis_off()
    return page
