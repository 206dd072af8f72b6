"""A block on a table, pushed at its side: what its two contacts carry, as the push grows."""

import numpy as np
from matplotlib import pyplot as plt

from quasistatic_ref import Contacts, StepData, solve_step
from quasistatic_ref.figures import panels, styled

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
        K_q=np.zeros((0, 0)),
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


def main():
    """For each push the friction and both normal forces, shape (3, 3) [N].

    How the corners share the friction is not determined: only its sum is unique.
    """
    answers = [solve_step(block(push)) for push in PUSHES]
    assert all(np.array_equal(answer.delta_q, np.zeros(3)) for answer in answers)
    return np.array([[a.wrench[:, 0].sum(), *a.wrench[:, 2]] for a in answers])


@styled
def figure():
    """One panel a push: the block, its weight, the push and the forces of the table."""
    metres = 0.008  # per newton
    made, row = panels(6.3, 2.6, columns=3, sharey=True)
    for axes, push, (friction, left, right) in zip(row, PUSHES, main(), strict=True):
        corner, size = (-HALF_WIDTH, 0.0), (2 * HALF_WIDTH, 2 * HALF_HEIGHT)
        axes.add_patch(plt.Rectangle(corner, *size, facecolor="0.88", edgecolor="0.3"))
        axes.axhline(0.0, color="0.3", linewidth=1.2)
        centre = (0.0, HALF_HEIGHT)
        arrows = [
            (centre, (0.0, -MASS * GRAVITY), "0.3"),
            (centre, (push, 0.0), "C1"),
            ((0.0, 0.0), (friction, 0.0), "C0"),
            ((-HALF_WIDTH, 0.0), (0.0, left), "C0"),
            ((HALF_WIDTH, 0.0), (0.0, right), "C0"),
        ]
        for start, force, colour in arrows:
            if np.hypot(*force) > 0:
                tip = np.add(start, metres * np.array(force))
                style = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.6}
                axes.annotate("", tip, start, arrowprops={**style, "shrinkA": 0, "shrinkB": 0})
        for x, f in ((-HALF_WIDTH, left), (HALF_WIDTH, right)):
            axes.text(x, -0.016, f"{f:.2f} N", ha="center", fontsize=8)
        axes.grid(visible=False)
        axes.set(xlim=(-0.09, 0.09), ylim=(-0.045, 0.11), aspect="equal")
        axes.set_title(f"push {push:g} N", fontsize=9)
        axes.set_xlabel("x [m]")
    row[0].set_ylabel("z [m]")
    return made


if __name__ == "__main__":
    print(main())
