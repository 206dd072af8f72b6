"""Step after step: the finger, its spring and the block of two unknowns, followed in time.

A run is a loop of four lines: where things are gives phi and J; the program gives delta_q; q goes
on by it; nothing else is kept. While the finger's target moves at v, the block comes to move at v,
and the finger is m v / (h K_q) behind its target, for the drag m v / h of a model without velocity.
When the target stops, so does all else.
"""

from functools import cache

import numpy as np

from docs.drawings.finger_spring_block import (
    GAP,
    K_Q,
    H,
    M,
    finger_and_block,
)
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

V, MOVES, TIME = 0.02, 1.2, 1.6
"""Speed of the target [m/s], how long it moves, length of the run [s]."""


@cache
def motion(K_q: float, m: float, h: float, v: float) -> tuple[Array, Array, Array, Array]:
    """Times [s], target and both places [m], and the force of each step [N].

    Parameters
    ----------
    K_q, m, h, v : float
        [N/m], [kg], [s], [m/s].

    Returns
    -------
    t, target : ndarray, shape (steps,)
        After each step [s], [m].
    q : ndarray, shape (steps + 1, 2)
        The finger's and the block's places [m].
    N : ndarray, shape (steps,)
        [N].
    """
    t = np.linspace(h, TIME, round(TIME / h))
    target = v * np.minimum(t, MOVES)
    q = [np.array([0.0, GAP])]
    N = []
    for q_bar in target:
        finger, block = q[-1]
        answer = solve_step(finger_and_block(K_q, m, h, q_bar - finger, block - finger))
        q.append(q[-1] + answer.delta_q)  # q (+) delta_q, of two numbers
        N.append(answer.wrench[0, 2])
    return t, target, np.array(q), np.array(N)


def main() -> dict[str, float]:
    """Force and lag while the target moves, with their formulas; motion after it has stopped."""
    t, target, q, N = motion(K_Q, M, H, V)
    moving = np.searchsorted(t, MOVES) - 1
    return {
        "force [N]": N[moving],
        "m v / h [N]": M * V / H,
        "lag of the finger [mm]": 1e3 * (target[moving] - q[moving + 1, 0]),
        "m v / (h K_q) [mm]": 1e3 * M * V / (H * K_Q),
        "largest place of the finger beyond its target [mm]": 1e3
        * float((q[1:, 0] - target).max(initial=0.0)),
        "none [mm]": 0.0,
    }


def figure(*, K_q: float = K_Q, m: float = M, h: float = H, v: float = V) -> Figure:
    """Places, and the force, against time.

    Parameters
    ----------
    K_q, m, h, v : float
        [N/m], [kg], [s], [m/s].
    """
    page, (left, right) = panels(6.3, 2.8, columns=2)
    t, target, q, N = motion(K_q, m, h, v)
    places = {"target": target, "finger": q[1:, 0], "block": q[1:, 1]}
    for name, place in places.items():
        left.plot(t, 1e3 * place, label=name)
    label_axes(left, "time t [s]", "x [mm]")
    right.step(t, N, where="pre", label="force")
    right.axhline(m * v / h, color="black", linestyle=":", label=r"$m v / h$")
    label_axes(right, "time t [s]", "force [N]", caption(h, "frictionless"))
    return page
