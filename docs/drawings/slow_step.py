"""A step, and the same step without drag: the force of a finger that wipes, and of two that lift.

The finger is to press with 5 N; what slides rises, so that it presses with more, (R13). The two
press with 12 N each and lift 1 kg: drag makes it slip, what slips rises, and both add to friction.
Without drag it sticks, and nothing rises.
"""

from typing import Any

import numpy as np

import quasistatic_ref as qr
from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.step.data import StepData

TIMES = np.array([2e-3, 5e-3, 10e-3, 20e-3, 50e-3, 100e-3])
V, MU_V, SLOWLY = 0.05, 0.5, 10.0
STYLES = {"run": "o", "without drag": "^", "without drag and layer": "s"}
PEN: dict[str, Any] = {"color": "black", "markerfacecolor": "none", "linewidth": 0.9}
GREY: dict[str, Any] = {"color": "0.6", "linewidth": 3, "label": "formula (R13); half the weight"}
FINGERS = {
    "wiper": (2e4, [0, 0, 0.01], [0, 0, 0.00975], [V, 0, 0]),
    "left": (1e6, [-0.06, 0, 0], [-0.06 + 12e-6, 0, 0], [0, 0, V]),
    "right": (1e6, [0.06, 0, 0], [0.06 - 12e-6, 0, 0], [0, 0, V]),
}
"""K_q [N/m], start [m], first target [m] and its velocity [m/s]."""


def finger(name: str) -> dict[str, Any]:
    """A ball on springs, as a table of a scenario."""
    K, start, first, velocity = FINGERS[name]
    tip = qr.Body.of_shape(name, qr.Sphere(0.01), mass=0.1, xyz=start, actuated=["base"])
    way = [
        {"t": t, "base": {"xyz": [x + t * v for x, v in zip(first, velocity, strict=True)]}}
        for t in (0.0, 10.0)
    ]
    return {"body": tip, "K_q": {"base": [K, K, K, 1e4, 1e4, 1e4]}, "targets": way}


def last_step(h: float, lifts: bool) -> StepData:
    """The last of twenty steps of the two that lift, or of the one that wipes."""
    box = qr.Body.of_shape("box", qr.Box((0.05, 0.05, 0.05)), mass=1.0)
    floor = {"floor": qr.HalfSpace((0, 0, 1), 0.0)}
    names = ("left", "right") if lifts else ("wiper",)
    contact = {"alpha": [*names] if lifts else "floor", "beta": "box" if lifts else "wiper"}
    torsion = {"rows": 6, "mu_omega": 0.01} if lifts else {"rows": 4}
    scene = {
        "h": h, "steps": 20, "fast": True, "shapes": {} if lifts else floor,
        "bodies": {name: finger(name) for name in names} | ({"box": box} if lifts else {}),
        "contacts": {"c": contact | torsion | {"mu_v": MU_V, "k": 1}},
    }  # fmt: skip
    return qr.load_scenario(scene).run(progress=False).step_data(19)


def forces(step: StepData) -> list[Array]:
    """The force of the first contact in each of `STYLES`, shape (4,) [N, N, N, N m]."""
    slow = step.replace(h=SLOWLY)
    solutions = [qr.solve_step(step), qr.solve_step(slow), qr.coulomb_step(slow)]
    return [solution.wrench[0] for solution in solutions]


def figure() -> Figure:
    """The normal force of the wiper, and the friction of a finger that lifts, over h."""
    page, axes = panels(6.3, 2.9, columns=2)
    for one, lifts in zip(axes, (False, True), strict=True):
        each = np.array([forces(last_step(float(h), lifts)) for h in TIMES])
        shown = np.hypot(each[..., 0], each[..., 1]) if lifts else each[..., 2]
        if not lifts:
            one.plot(1e3 * TIMES, 2e4 * (0.25e-3 + MU_V * TIMES * V), **GREY)
        else:
            one.axhline(GRAVITY / 2, **GREY)
        for (law, style), values in zip(STYLES.items(), shown.T, strict=True):
            one.plot(1e3 * TIMES, values, style, label=law, **PEN)
        one.set_xscale("log")
        label_axes(one, "h [ms]", "friction [N]" if lifts else "normal force [N]", key=False)
        one.set_title("two fingers of 12 N lift 1 kg" if lifts else "a finger of 5 N wipes")
        one.set_ylim(bottom=0)
    legend_below(axes, axes[0].get_legend_handles_labels()[0])
    return page
