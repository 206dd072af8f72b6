"""The grasp matrix of two soft fingers on a bar: which force and torque each of its columns is."""

import numpy as np

from quasistatic_ref.lab.made_steps.pinch import pinch_step
from quasistatic_ref.optional.show.figures import Figure, panels

OFFSET = 0.04
"""Of the fingers, along y from the centre of mass [m]."""
COLUMNS = ("$f_1$", "$f_2$", "$f_n$", r"$\tau_n$")
ROWS = ("$F_x$ [N]", "$F_y$ [N]", "$F_z$ [N]", "$T_x$ [N m]", "$T_y$ [N m]", "$T_z$ [N m]")


def main() -> np.ndarray:
    """G, shape (6, 8): the columns of the bar's coordinates of J along d1, d2, n and about n."""
    step = pinch_step(5.0, OFFSET, 0.5, 0.02)
    contacts = step.contacts
    G = np.zeros((6, 8))
    for j, J in enumerate(contacts.J[:, :, step.n_a :]):
        frame = np.array([contacts.d1[j], contacts.d2[j], contacts.n[j]])
        G[:, 4 * j : 4 * j + 3] = (frame @ J[:3]).T
        G[:, 4 * j + 3] = J[3]
    # Without tau_n nothing turns the bar about the line of the fingers, x.
    forces = G[:, [0, 1, 2, 4, 5, 6]]
    about = np.array([0.0, 0.0, OFFSET, 1.0, 0.0, 0.0])  # T_x about the line, from F_z and T_x
    assert np.linalg.matrix_rank(forces) == 5
    assert np.linalg.matrix_rank(G) == 6
    assert not np.allclose(about @ G[:, [3, 7]], 0)
    return G


def figure() -> Figure:
    """The matrix as a table with the numbers in it."""
    page, (axes,) = panels(6.3, 3.2)
    G = main()
    largest = np.abs(G).max()
    axes.imshow(G, cmap="RdBu", vmin=-2 * largest, vmax=2 * largest, aspect="auto")
    for (row, column), value in np.ndenumerate(G):
        if value:
            axes.text(column, row, f"{value:g}", ha="center", va="center")
    axes.axvline(3.5, color="black", linewidth=1.2)
    axes.axhline(2.5, color="0.5", linewidth=0.8)
    axes.set_xticks(range(8), [*COLUMNS, *COLUMNS])
    axes.set_yticks(range(6), ROWS)
    axes.tick_params(length=0)
    axes.grid(visible=False)
    for middle, finger in ((1.5, "left finger"), (5.5, "right finger")):
        axes.text(middle, -0.6, f"a unit of the {finger}'s", ha="center", va="bottom")
    return page
