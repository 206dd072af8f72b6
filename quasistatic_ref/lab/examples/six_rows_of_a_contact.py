"""The six rows of one contact, and which of them hold back a ball that slides and spins.

Each row i of Eq. (4) is an opening that must not become negative: how far the ball has risen, plus
mu_v times its slip along +d1, +d2, -d1 or -d2, or plus mu_omega times its turn about n, one way or
the other. So the row named -d1 closes when the ball slides along +d1, and pushes it back along -d1.
A ball that only slides along d1 stands on one of the six; one that slides and spins so that both
cost the same stands on two. The rows that it stands on push back, all others are open.
"""

import numpy as np

from quasistatic_ref.figures import Figure, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

M, RADIUS, MU_V, MU_OMEGA, H = 0.3, 0.05, 0.5, 0.01, 0.01
ROWS = ("+d1", "+d2", "-d1", "-d2", "+spin", "-spin")
LOADS = {"at rest": (0.0, 0.0), "pushed along d1": (2.0, 0.0), "turned about n": (0.0, 2.0)}
"""Push over mu_v m g, torque over mu_omega m g [-]."""


def loaded(push: float, turn: float) -> StepData:
    """A ball on the floor, with a push where it touches and a turn about the vertical.

    Parameters
    ----------
    push, turn : float
        Over what friction holds, mu_v m g and mu_omega m g [-].
    """
    force, torque = push * MU_V * M * GRAVITY, turn * MU_OMEGA * M * GRAVITY
    wrench = (force, 0, -M * GRAVITY, 0, -RADIUS * force, torque)
    inertia = 0.4 * M * RADIUS**2
    return sphere_step(M, inertia, RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=0.0, h=H)


def rows(push: float, turn: float) -> tuple[Array, Array]:
    """Opening A delta_q - b of the six rows [m], and their forces lam / h [N], shapes (6,).

    Parameters
    ----------
    push, turn : float
        As for :func:`loaded` [-].
    """
    step = loaded(push, turn)
    solution, form = solve_step(step), standard_form(step)
    return form.A @ solution.delta_q - form.b, solution.lam / H


def main() -> Numbers:
    """How many rows are closed under each load; their forces add up to the normal force."""
    found = {name: rows(*load) for name, load in LOADS.items()}
    closed = {
        f"closed rows, {name} [-]": float(np.sum(np.abs(opening) < 1e-12))
        for name, (opening, _) in found.items()
    }
    return closed | {
        "sum of the forces at rest [N]": found["at rest"][1].sum(),
        "weight [N]": M * GRAVITY,
    }


@styled
def figure() -> Figure:
    """The opening of each row under each load."""
    page, grid = panels(6.3, 2.4, columns=len(LOADS), sharey=True)
    for axes, (name, load) in zip(grid, LOADS.items(), strict=True):
        opening, force = rows(*load)
        axes.bar(ROWS, 1e6 * opening, color="white", edgecolor="black")
        for k in np.flatnonzero(force > 1e-9):
            axes.plot(k, 0, marker="^", color="#D55E00", clip_on=False, zorder=5)
        axes.tick_params(axis="x", rotation=60)
        axes.set_title(name)
    grid[0].set_ylabel(r"opening of the row [$\mu$m]")
    page.suptitle(r"triangles: the rows that push; h = 10 ms, friction pyramid", fontsize="medium")
    return page


if __name__ == "__main__":
    script(main, figure)
