"""The quadratic program of one contact, drawn: a wedge, level lines, and where the answer lies."""

import numpy as np

from quasistatic_ref import Contacts, StepData, solve_step
from quasistatic_ref.figures import panels, styled

H, MASS, GRAVITY, MU_V = 0.01, 1.0, 9.81, 0.5  # s, kg, m/s^2, -
PUSHES = (3.0, 8.0)  # N: one that is held, one that is not


def point(push):
    """A point on the floor that moves by delta_q = (dx, dz).

    Parameters
    ----------
    push : float
        Horizontal force [N].
    """
    return StepData(
        h=H,
        K_q=np.zeros((0, 0)),
        M_u=MASS * np.eye(2),
        tau_a=[],
        tau_u=[push, -MASS * GRAVITY],
        delta_q_bar_a=[],
        contacts=Contacts(
            name=("floor",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]],
            J=[[[1, 0], [0, 0], [0, 1], [0, 0]]], mu_v=[MU_V], mu_omega=[0.0], rows=[4],
        ),
    )  # fmt: skip


def main():
    """delta_q for each push, shape (2, 2) [m]: zero, then (R8) with F = 8 N."""
    return np.array([solve_step(point(push)).delta_q for push in PUSHES])


@styled
def figure():
    """One panel a push: the rows, level lines of the objective, both minimisers."""
    microns = 1e6
    x, z = np.meshgrid(np.linspace(-0.7e-3, 1.2e-3, 200), np.linspace(-1.15e-3, 0.7e-3, 200))
    made, row = panels(6.3, 2.9, columns=2, sharey=True)
    for axes, push, (dx, dz) in zip(row, PUSHES, main(), strict=True):
        value = MASS * (x**2 + z**2) / (2 * H) - H * (push * x - MASS * GRAVITY * z)
        axes.contour(
            microns * x, microns * z, value, 14, colors="0.75", linestyles="solid", linewidths=0.5
        )
        line = microns * x[0]
        axes.fill_between(line, MU_V * np.abs(line), 700, color="C0", alpha=0.15)
        axes.plot(line, MU_V * np.abs(line), color="C0")
        free = microns * H**2 * np.array([push, -MASS * GRAVITY]) / MASS
        axes.plot(*free, "o", color="0.3", markerfacecolor="white")
        axes.plot(microns * dx, microns * dz, "s", color="C1")
        axes.annotate(
            "without contact", free, xytext=(-6, 6), textcoords="offset points", ha="right"
        )
        axes.annotate(
            "answer", (microns * dx, microns * dz), xytext=(6, -12), textcoords="offset points"
        )
        axes.text(-600, 560, "allowed", color="C0", va="center")
        axes.set_title(f"push {push:g} N", fontsize=9)
        axes.set_xlabel("dx [µm]")
        axes.set_ylim(-1150, 700)
    row[0].set_ylabel("dz [µm]")
    return made


if __name__ == "__main__":
    print(main())
