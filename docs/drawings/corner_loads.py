"""A block on a table, pushed at its side: what its two contacts carry, as the push grows."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import Contacts, StepData, solve_step
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.optional.show.figures.style import scaled

H, MASS, GRAVITY, MU_V = 0.01, 1.0, 9.81, 0.5  # s, kg, m/s^2, -
HALF_WIDTH, HALF_HEIGHT = 0.05, 0.04  # m
PUSHES = (0.0, 2.0, 4.0)  # N, in the middle of the side; the limit is 4.905


def block(push):
    """The block in its plane, delta_q = (dx, dz, dtheta), on its two lower corners.

    Parameters
    ----------
    push : float
        Horizontal force at the centre of mass [N].
    """
    J = np.zeros((2, 4, 3))
    for j, x in enumerate((-HALF_WIDTH, HALF_WIDTH)):
        # theta turns z towards x: a corner at (x, z) moves by theta (z, -x).
        J[j, :3] = [[1, 0, -HALF_HEIGHT], [0, 0, 0], [0, 1, -x]]
    inertia = MASS * ((2 * HALF_WIDTH) ** 2 + (2 * HALF_HEIGHT) ** 2) / 12
    both = np.ones((2, 1))
    return StepData(
        h=H,
        K_q=[],
        M_u=np.diag([MASS, MASS, inertia]),
        tau_a=[],
        tau_u=[push, -MASS * GRAVITY, 0.0],
        delta_q_bar_a=[],
        contacts=Contacts(
            name=("left", "right"),
            phi=[0.0, 0.0],
            n=both * [0, 0, 1],
            d1=both * [1, 0, 0],
            d2=both * [0, 1, 0],
            J=J,
            mu_v=[MU_V, MU_V],
            mu_omega=[0.0, 0.0],
            rows=[4, 4],
        ),
    )


def main(pushes=PUSHES):
    """For each push the friction and both normal forces, shape (pushes, 3) [N].

    How the corners share the friction is not determined: only its sum is unique.
    """
    answers = [solve_step(block(push)) for push in pushes]
    assert all(np.array_equal(answer.delta_q, np.zeros(3)) for answer in answers)
    return np.array([[a.wrench[:, 0].sum(), *a.wrench[:, 2]] for a in answers])


def figure(*, pushes=PUSHES):
    """One panel a push: the block, its weight, the push and the forces of the table."""
    mm_per_newton = 8
    made, row = panels(6.3, 3.0, columns=len(pushes), sharey=True)
    styles = {
        "weight": {"color": "0.3", "linewidth": scaled(1.6)},
        "push": {"color": "#D55E00", "linewidth": scaled(1.6), "linestyle": (0, (3, 1))},
        "forces of the table": {"color": "#0072B2", "linewidth": scaled(3.0)},
    }
    left = -1e3 * HALF_WIDTH
    top = 2e3 * HALF_HEIGHT
    for axes, push, (friction, f_left, f_right) in zip(row, pushes, main(pushes), strict=True):
        axes.add_patch(Rectangle((left, 0), -2 * left, top, facecolor="0.88", edgecolor="0.3"))
        axes.axhline(0.0, color="0.3", linewidth=scaled(1.2))
        arrows = [
            ((0.0, top / 2), (0.0, -MASS * GRAVITY), "weight"),
            ((0.0, top / 2), (push, 0.0), "push"),
            ((0.0, 0.0), (friction, 0.0), "forces of the table"),
            ((left, 0.0), (0.0, f_left), "forces of the table"),
            ((-left, 0.0), (0.0, f_right), "forces of the table"),
        ]
        for start, force, name in arrows:
            if np.hypot(*force) > 0:
                tip = np.add(start, mm_per_newton * np.array(force))
                look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, **styles[name]}
                axes.annotate("", tip, start, arrowprops=look)
        for x, f in ((left, f_left), (-left, f_right)):
            axes.text(x, -16, f"{f:.2f} N", ha="center", va="center")
        axes.grid(visible=False)
        axes.set(xlim=(-95, 95), ylim=(-45, 110), aspect="equal")
        axes.set_title(f"push {push:g} N")
        label_axes(axes, "x [mm]", "z [mm]")
        axes.label_outer(remove_inner_ticks=True)
    handles = [Line2D([], [], label=name, **style) for name, style in styles.items()]
    legend_below(row, handles, f"1 N is {mm_per_newton} mm")
    return made


if __name__ == "__main__":
    print(main())
