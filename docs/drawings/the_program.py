"""The quadratic program of one contact, drawn: a wedge, level lines, and where the answer lies."""

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import Contacts, StepData, solve_step
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.optional.show.figures.style import scaled

H, MASS, GRAVITY, MU_V = 0.01, 1.0, 9.81, 0.5  # s, kg, m/s^2, -
PUSHES = (3.0, 6.0)  # N: one that is held, one that is not


def point(push, mu_v=MU_V, h=H):
    """A point on the floor that moves by delta_q = (dx, dz).

    Parameters
    ----------
    push : float
        Horizontal force [N].
    mu_v, h : float
        [-], [s].
    """
    return StepData(
        h=h,
        K_q=[],
        M_u=MASS * np.eye(2),
        tau_a=[],
        tau_u=[push, -MASS * GRAVITY],
        delta_q_bar_a=[],
        contacts=Contacts(
            name=("floor",), phi=[0.0], n=[[0, 0, 1]], d1=[[1, 0, 0]], d2=[[0, 1, 0]],
            J=[[[1, 0], [0, 0], [0, 1], [0, 0]]], mu_v=[mu_v], mu_omega=[0.0], rows=[4],
        ),
    )  # fmt: skip


def main():
    """delta_q for each push, shape (2, 2) [m]: zero, then (R8) with F = 6 N."""
    return np.array([solve_step(point(push)).delta_q for push in PUSHES])


def figure(*, pushes=PUSHES, mu_v=MU_V, h=H):
    """One panel a push: the rows, level lines of the objective, both minimisers.

    M_u is the mass times the identity, so that level lines are circles on equal axes and the answer
    is the point of the wedge that is nearest to where the point would go without contact.
    """
    free = 1e6 * h**2 * np.array([[push, -MASS * GRAVITY] for push in pushes]) / MASS
    deep = 1e6 * h**2 * GRAVITY
    x, z = np.meshgrid(np.linspace(-0.7, 1.3, 200) * deep, np.linspace(-1.2, 0.75, 200) * deep)
    made, row = panels(6.3, 3.3, columns=len(pushes), sharey=True)
    for axes, push, (to_x, to_z) in zip(row, pushes, free, strict=True):
        away = np.hypot(x - to_x, z - to_z) / deep
        axes.contour(x, z, away, np.arange(0.1, 2.5, 0.15), colors="0.75", linestyles="solid",
                     linewidths=scaled(0.5))  # fmt: skip
        line = x[0]
        axes.fill_between(line, mu_v * np.abs(line), z.max(), color="#0072B2", alpha=0.15)
        axes.plot(line, mu_v * np.abs(line), color="#0072B2", label=r"rows: dz = $\mu_v$ |dx|")
        answer = 1e6 * solve_step(point(push, mu_v, h)).delta_q
        axes.plot(*np.stack([answer, (to_x, to_z)]).T, "k:", linewidth=scaled(1))
        style = {"markersize": scaled(5), "linestyle": ""}
        axes.plot(to_x, to_z, "o", color="black", markerfacecolor="white", label="without contact",
                  **style)  # fmt: skip
        axes.plot(*answer, "s", color="#D55E00", label="answer", **style)
        axes.text(0, 0.6 * deep, "allowed", color="#0072B2", ha="center", va="center")
        axes.set(xlim=(x.min(), x.max()), ylim=(z.min(), z.max()), aspect="equal")
        axes.grid(visible=False)
        label_axes(axes, "dx [µm]", "dz [µm]", f"push {push:g} N", key=False)
        axes.label_outer(remove_inner_ticks=True)
    handles = [line for line in row[0].lines if not line.get_label().startswith("_")]
    legend_below(row, handles)
    return made


if __name__ == "__main__":
    print(main())
