"""A finger on a spring pushes a block on ice: a step with two unknowns, and the first K_q.

The finger's place is actuated: a spring of K_q pulls it to its target, delta_q_bar_a ahead. The
block is not. They are a gap phi apart, and the one row says that they stay apart,
phi + delta_q_u - delta_q_a >= 0. Where the spring alone would close the gap, the row is tight, its
force N pushes the block and holds back the finger, K_q (delta_q_bar_a - delta_q_a) = N, and
m delta_q_u / h^2 = N.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import X, Y, Z, contacts_of
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData

K_Q, M, H, TARGET, GAP = 500.0, 0.5, 0.02, 4e-3, 1e-3
"""Stiffness [N/m], mass [kg], time step [s], delta_q_bar_a and phi [m]."""


def finger_and_block(
    K_q: float = K_Q, m: float = M, h: float = H, target: float = TARGET, phi: float = GAP
) -> StepData:
    """The step: delta_q is how far the finger and the block go along x [m].

    Parameters
    ----------
    K_q, m, h : float
        [N/m], [kg], [s].
    target, phi : float
        How far ahead of the finger its target and the block are [m].
    """
    J = np.zeros((1, 4, 2))
    J[0, 0] = [-1.0, 1.0]  # the block's point relative to the finger's, along the world's x
    contact = contacts_of(phi, np.array([[Y, Z, X]]), J, mu_v=0.0)  # n from the finger to the block
    return StepData(h, [[K_q]], [[m]], np.zeros(1), np.zeros(1), [target], contact)


def main() -> dict[str, float]:
    """Both motions and the force, each followed by its formula."""
    answer = solve_step(finger_and_block())
    finger = (H**2 * K_Q * TARGET + M * GAP) / (H**2 * K_Q + M)
    return {
        "the finger goes [mm]": 1e3 * answer.delta_q[0],
        "(h^2 K_q delta_q_bar_a + m phi) / (h^2 K_q + m) [mm]": 1e3 * finger,
        "the block goes [mm]": 1e3 * answer.delta_q[1],
        "phi less than the finger [mm]": 1e3 * (finger - GAP),
        "force [N]": answer.wrench[0, 2],
        "K_q m (delta_q_bar_a - phi) / (h^2 K_q + m) [N]": K_Q
        * M
        * (TARGET - GAP)
        / (H**2 * K_Q + M),
    }


def figure(
    *, K_q: float = K_Q, m: float = M, h: float = H, target: float = TARGET,
    phi: float = GAP,
) -> Figure:  # fmt: skip
    """The scene; and the plane of both unknowns: level lines, the row, both minimisers.

    Parameters
    ----------
    K_q, m, h, target, phi : float
        Those of :func:`finger_and_block` [N/m], [kg], [s], [m], [m].
    """
    page, (left, right) = panels(6.3, 3.2, columns=2)
    gap = 1e3 * phi
    free = 1e3 * target
    answer = 1e3 * solve_step(finger_and_block(K_q, m, h, target, phi)).delta_q
    top = 1.6 * gap
    coil = np.linspace(0.0, 1.0, 80)
    way = free * coil
    wave = 2.2 * top + 0.25 * gap * np.sin(40 * coil)
    left.plot(way, wave, "k-", linewidth=scaled(0.7), label="spring to the target")
    left.fill_between([-2 * gap, 0], 0, top, facecolor="0.75", edgecolor="0.3", label="finger")
    left.fill_between(
        [gap, free + gap], 0, 2 * top, facecolor="0.9", edgecolor="0.3", label="block"
    )
    left.axhline(0, color="0.3", linestyle="-")
    left.axvline(free, color="#009E73", linestyle="--", label="target")
    left.set(xlim=(-2.4 * gap, free + 1.4 * gap), ylim=(-gap / 2, 2.6 * top), yticks=[])
    label_axes(left, "x [mm]")
    reach = 1.35 * max(free, gap)
    a, u = np.meshgrid(np.linspace(-0.35, 1.0, 200) * reach, np.linspace(-0.6, 0.75, 200) * reach)
    value = h / 2 * K_q * (a - free) ** 2 + m * u**2 / (2 * h)
    right.contour(a, u, np.sqrt(value), 12, colors="0.75", linestyles="solid",
                  linewidths=scaled(0.5))  # fmt: skip
    line = a[0]
    right.fill_between(line, line - gap, u.max(), color="#0072B2", alpha=0.15)
    right.plot(line, line - gap, color="#0072B2", label="the row")
    marks: dict[str, Any] = {"linestyle": "", "markersize": scaled(5)}
    right.plot(free, 0, "o", color="black", markerfacecolor="white", label="without it", **marks)
    right.plot(*answer, "s", color="#D55E00", label="answer", **marks)
    right.set(xlim=(a.min(), a.max()), ylim=(u.min(), u.max()), aspect="equal")
    right.grid(visible=False)
    label_axes(right, r"$\delta q_a$ [mm]", r"$\delta q_u$ [mm]", caption(h, "frictionless"))
    return page
