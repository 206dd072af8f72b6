"""The same scenes under both laws of friction: what it costs that sliding contacts rise.

A block that is pushed, a sphere that is turned, the grasp of the bunny, and a measured push of a
real object, each in the convex model and under Coulomb's law. In the last panel both laws end the
push almost at one place, next to that which was measured.
"""

from functools import cache
from typing import Any

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from docs.drawings.reality_pushes import measurements
from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.lab.grasp import CLOSED
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.lab.made_steps.rigid import point_step, sphere_step
from quasistatic_ref.lab.reality.measurements import Pair
from quasistatic_ref.lab.reality.predict import prediction
from quasistatic_ref.lab.reality.push import pushed_scene
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.coulomb.fixed_point import coulomb_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.simulate.law import CONVEX, COULOMB, LAWS
from quasistatic_ref.simulate.record.motions import link_motion
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData

M = 0.3
INERTIA = 2e-4
RADIUS = 0.04
MU_V = 0.5
MU_OMEGA = 0.02
H = 0.01
WEIGHT = M * GRAVITY
LOADS = np.linspace(0.0, 3.0, 13)
"""Over what friction bears [-]."""
PUSH = 4
"""Of the pushes of ``reality_pushes``."""
ADVANCE, STEPS = 2e-3, 300
"""Of the finger in a step [m]; of the grasp."""
TITLES = ("a block, one step", "a sphere, one step", "the bunny in its grip", "a measured push")
STYLES = {CONVEX: "o-", COULOMB: "^--"}
PEN: dict[str, Any] = {"color": "black", "markerfacecolor": "none", "linewidth": 0.9}


def block(load: float) -> StepData:
    """A block on a floor, pushed by `load` times what its friction bears [-]."""
    return point_step(M, (load * MU_V * WEIGHT, 0.0, -WEIGHT), MU_V, 0.0, H)


def sphere(load: float) -> StepData:
    """A sphere on a floor, turned by `load` times what its friction bears [-]."""
    wrench = (0.0, 0.0, -WEIGHT, 0.0, 0.0, load * MU_OMEGA * WEIGHT)
    return sphere_step(M, INERTIA, RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=0.0, h=H)


def motion(step: StepData, law: str) -> Array:
    """delta_q of a step under a law, shape (n_v,) [m, rad]."""
    return (coulomb_step if law == COULOMB else solve_step)(step, "daqp").delta_q


@cache
def rotation_of_the_bunny(law: str) -> tuple[Array, Array]:
    """Times [s], and its turn since the grip closed [deg], each of shape (steps + 1,)."""
    scenario = load_scenario("bunny_grasp", steps=STEPS, law=law, record="light", fast=True)
    found = link_motion(scenario.system, scenario.run(progress=False, findings=False), "bunny")
    return found.times, np.degrees(found.rotation_since(CLOSED))


@cache
def push(law: str) -> tuple[Pair, Array]:
    """An object, and its poses before a push, after it as measured, and after it by a law, (3, 3).

    x, y [m] and angle [rad] of its frame.
    """
    pair, ratio, pushes = measurements()
    scene = pushed_scene(Settings(advance=ADVANCE, law=law), pair, ratio)
    found = prediction(scene, pushes.before[PUSH], pushes.path[PUSH]).pose
    return pair, np.array([pushes.before[PUSH], pushes.after[PUSH], found])


def figure(*, h: float = H) -> Figure:
    """Slip and turn of one step against the load; the grasp in time; the push from above.

    Parameters
    ----------
    h : float
        [s].
    """
    page, axes = panels(6.3, 5.2, columns=2, rows=2)
    beyond = h**2 * GRAVITY * np.maximum(LOADS - 1, 0)
    scenes = (
        (block, 0, MU_V, r"push / ($\mu_v m g$) [-]", "slip [mm]"),
        (sphere, 5, MU_OMEGA * M / INERTIA, r"torque / ($\mu_\omega m g$) [-]", "turn [mrad]"),
    )
    for one, (scene, i, per, x, y) in zip(axes, scenes, strict=False):
        one.plot(LOADS, 1e3 * per * beyond, color="0.6", linewidth=3, label="Coulomb's formula")
        for law, style in STYLES.items():
            moved = [1e3 * motion(scene(load).replace(h=h), law)[i] for load in LOADS]
            one.plot(LOADS, moved, style, label=law, **PEN)
        label_axes(one, x, y, key=False)
    pair, (before, after, _) = push(CONVEX)
    outlines = {law: pair.outline.line_at(push(law)[1][2], before) for law in LAWS}
    for law, style in STYLES.items():
        time, angle = rotation_of_the_bunny(law)
        since = time >= CLOSED
        axes[2].plot(time[since], angle[since], style, markevery=0.2, **PEN)
    label_axes(axes[2], "t [s]", "bunny's turn [deg]", key=False)
    axes[3].plot(*pair.outline.line_at(before, before), color="0.6", linestyle=":", label="before")
    axes[3].fill(*pair.outline.line_at(after, before), color="0.85", label="measured")
    for law, style in STYLES.items():
        axes[3].plot(*outlines[law], style, markevery=0.2, **PEN)
    axes[3].set_aspect("equal", adjustable="datalim")
    label_axes(axes[3], "x [mm]", "y [mm]", key=False)
    for one, title in zip(axes, TITLES, strict=True):
        one.set_title(title, loc="left")
        one.locator_params(nbins=4)
    handles = [*axes[0].get_legend_handles_labels()[0], *axes[3].get_legend_handles_labels()[0]]
    legend_below(axes, handles)
    return page
