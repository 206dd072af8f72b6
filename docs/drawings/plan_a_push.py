"""A plan by gradient descent: one finger pushes a block to a pose, in forty steps.

The plan says where on the block's back the finger aims at each step, and how far into it. Its
gradient goes through forty smoothed steps, whose barriers give way as the descent goes on. Then the
plan is executed in exact steps, each of them certified; with a support that resists turning, and
with one that does not.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.lab.figures.labels import caption, label_axes, legend_below
from quasistatic_ref.lab.scenes.pushed_block import MU_OMEGA, OFFSET, RADIUS, SIDE, pushed_block
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.step_jax import jax_package, smoothed_jax
from quasistatic_ref.optional.show.figures import Figure, panels

jax = jax_package()
np_jax = jax.numpy

H, STEPS, GAP, ARM = 0.05, 40, 1e-3, 0.05
"""Time step [s]; steps [-]; the finger's first distance [m]; what a turn is multiplied by [m]."""
GOAL, STARTS = np.array([0.15, 0.0]), ((0.0, 0.02, 0.2), (0.0, -0.03, 0.3), (-0.02, 0.0, -0.5))
"""Where the block has to go, its angle being zero; x, y [m] and angle [rad] at starts."""
DEPTH, ASIDE = 0.005, 0.4 * SIDE
"""What one unit of a plan is into the block, and how far to the side a plan may aim [m]."""
SUPPORTS = {"with torsion": MU_OMEGA, "without torsion": 0.0}
"""mu_omega of the support [m]."""
KAPPAS = np.geomspace(1e-5, 1e-8, 40)
"""Weights of the barriers, one for each step of the descent [N m s]."""


class Push(NamedTuple):
    """A plan executed: q (41, 7), certified steps, misses of the descent [m], what is left (3,)."""

    q: Array
    certified: int
    misses: list[float]
    left: Array


def aim(q: Any, row: Any) -> Any:
    """The finger's target, (2,) [m], for a row of the plan: into the block, and to the side."""
    c = q[5]
    s = q[6]
    along = DEPTH * row[0] - SIDE / 2 - RADIUS
    aside = ASIDE * np_jax.tanh(row[1])
    return q[2:4] + np_jax.array([c * along - s * aside, s * along + c * aside]) - OFFSET


def miss(q: Any) -> Any:
    """How far the block is from its goal, (3,) [m]: x, y and its turn times ARM."""
    return np_jax.array([*(q[2:4] - GOAL), ARM * np_jax.arctan2(q[6], q[5])])


@cache
def planned_push(start: tuple[float, float, float], mu_omega: float) -> Push:
    """A push from `start`, a pose of the block [m, rad], on a support of some mu_omega [m]."""
    scene = pushed_block(h=H, cone="pyramid", mu_omega=mu_omega)
    run = [scene.q_at(*start, GAP)]
    step = smoothed_jax(scene.simulator)
    certified = 0

    def loss(plan: Any, kappa: float) -> Any:
        start_q = np_jax.array(run[0])
        q, _ = jax.lax.scan(lambda q, row: step(q, aim(q, row), kappa), start_q, plan)
        return (miss(q) ** 2).sum() / 2

    with jax.enable_x64(True):
        gradient = jax.jit(jax.value_and_grad(loss))
        misses = []
        plan = np.tile([1.0, 0.0], (STEPS, 1))
        for kappa in KAPPAS:
            value, slope = map(np.asarray, gradient(plan, kappa))
            misses.append(float(np.sqrt(2 * value)))
            size = float(np.linalg.norm(slope))
            plan = plan - min(2 * value / size, 1.0) * slope / size  # to where a line has its zero
        for row in plan:
            result = scene.simulator.step(run[-1], np.asarray(aim(run[-1], row)))
            run.append(result.q)
            certified += result.solution.certificate.kind == "exact"
        return Push(np.array(run), certified, misses, np.asarray(miss(run[-1])))


def figure(*, start: tuple[float, float, float] = STARTS[0]) -> Figure:
    """Both pushes from `start` [m, rad], from above, and how far the descent was from the goal."""
    page, grid = panels(6.3, 3.0, columns=3, width_ratios=(3, 3, 2))
    for axes, (name, mu_omega), style in zip(grid, SUPPORTS.items(), ("-", "--"), strict=False):
        push = planned_push(start, mu_omega)
        _block(axes, push.q[0], "--", "0.5", "start")
        _block(axes, push.q[-1], "-", "C0", "end")
        _block(axes, np.array([0, 0, *GOAL, 0, 1, 0]), ":", "black", "goal")
        axes.plot(*(1e3 * (push.q[:, :2] + OFFSET)).T, "-", color="C1", label="path of the finger")
        ahead = 0.5 * SIDE * push.q[::5, 5:7]
        axes.quiver(*(1e3 * push.q[::5, 2:4]).T, *(1e3 * ahead).T, color="C0", angles="xy",
                    scale_units="xy", scale=1, width=0.012)  # fmt: skip
        axes.set(aspect="equal", xlim=(-90, 220), ylim=(-120, 120))
        label_axes(axes, "x [mm]", "y [mm]", name, key=False)
        grid[2].semilogy(1e3 * np.array(push.misses), style, label=name)
    label_axes(grid[2], "descent [steps]", "miss [mm]")
    arrows = f"arrows: the block's direction every 5 steps; {caption(H)}"
    legend_below(list(grid), grid[0].get_legend_handles_labels()[0], arrows)
    return page


def _block(axes: Any, q: Array, style: str, color: str, label: str | None) -> None:
    c, s = q[5:7]
    unit = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]])
    corners = q[2:4] + SIDE / 2 * unit @ [[c, s], [-s, c]]
    axes.plot(*(1e3 * corners).T, style, color=color, label=label)
