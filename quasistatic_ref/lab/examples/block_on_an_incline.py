"""Two blocks on a slope of 25 degrees: the rough one stays, the smooth one slides.

What slides would accelerate. Here it moves at once at the speed at which the model's drag m v / h
balances what friction leaves of the weight, v = h g (sin a - mu_v cos a): no velocity is carried
from step to step.
"""

import numpy as np

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.step.data import Array

SLOPE, MU_V, G = np.radians(25), {"rough": 0.6, "smooth": 0.3}, 9.81


def travels() -> tuple[Array, dict[str, Array]]:
    """Times [s], and how far each block has gone down the slope [m]; shapes (41,)."""
    scenario, run = ran("block_incline", "steps=40")
    down = np.array([np.cos(SLOPE), 0, -np.sin(SLOPE)])
    bases = {name: scenario.system.joint(f"{name}/base").q for name in MU_V}
    gone = {name: (run["q"][:, q][:, :3] - run["q"][0, q][:3]) @ down for name, q in bases.items()}
    return np.append(0.0, run["t"]), gone


def main() -> Numbers:
    """Speeds at the end, and that of the formula."""
    times, gone = travels()
    h = times[1] - times[0]
    return {
        "speed of the rough block [mm/s]": 1e3 * (gone["rough"][-1] - gone["rough"][-2]) / h,
        "speed of the smooth block [mm/s]": 1e3 * (gone["smooth"][-1] - gone["smooth"][-2]) / h,
        "h g (sin a - mu_v cos a) [mm/s]": 1e3
        * float(h * G * (np.sin(SLOPE) - MU_V["smooth"] * np.cos(SLOPE))),
    }


@styled
def figure() -> Figure:
    """The blocks at the end, from the side; the way of each."""
    page, (left, right) = panels(6.3, 3.0, columns=2)
    scenario, run = ran("block_incline", "steps=40")
    draw_scene(left, moment(scenario, run, -1), view="xz", parts=("contacts", "cones", "forces"))
    times, gone = travels()
    for name, way in gone.items():
        right.plot(times, 1e3 * way, label=rf"$\mu_v$ = {MU_V[name]:g}")
    right.set(xlabel="time t [s]", ylabel="way down the slope [mm]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    right.legend()
    return page


if __name__ == "__main__":
    script(main, figure)
