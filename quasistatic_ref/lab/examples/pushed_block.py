"""A plate on a spring pushes a block over the floor: friction, and the model's own drag.

The lag of the plate behind its target measures the force. It is mu_v m g, and m v / h more: a
block starts every step from rest. The drag is small where the quasi-dynamic number v / (mu_v g h)
is; here it is a quarter of friction, on purpose.
"""

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.step.data import Array

M, MU_V, K_Q, V, G = 0.5, 0.4, 1000.0, 0.01, 9.81


def forces() -> Array:
    """Force of the spring after each step, shape (120,) [N]."""
    _, run = ran("block_push", "steps=120")
    force: Array = K_Q * (run["q_bar_a"][:, 0] - run["q"][1:, 0])
    return force


def main() -> Numbers:
    """The push at the end, and what it should be."""
    scenario, run = ran("block_push", "steps=120")
    return {
        "push [N]": forces()[-1],
        "friction mu_v m g [N]": MU_V * M * G,
        "drag m v / h [N]": M * V / scenario.h,
        "quasi-dynamic number [-]": run.header["quasi_dynamic_number"],
        "boundary layer [um]": 1e6 * run["phi"][-1, :4].max(),
    }


@styled
def figure() -> Figure:
    """The block under way, and the push against time."""
    page, (left, right) = panels(6.3, 3.0, columns=2)
    scenario, run = ran("block_push", "steps=120")
    draw_scene(left, moment(scenario, run, -1), view="xz", parts=("contacts", "cones", "forces"))
    right.plot(run["t"], forces(), label="spring")
    friction, drag = MU_V * M * G, M * V / scenario.h
    right.axhline(friction, color="black", linestyle=":", label=r"$\mu_v m g$")
    right.axhline(friction + drag, color="black", linestyle="--", label=r"$\mu_v m g + m v / h$")
    right.set(xlabel="time t [s]", ylabel="push [N]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    right.legend(loc="lower right")
    return page


if __name__ == "__main__":
    script(main, figure)
