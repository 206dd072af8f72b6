"""How the boundary layer shrinks with the time step: like h at a rate, like h^2 at a torque.

The paper calls the layer proportional to h. So it is where the motion is imposed, mu_omega h omega.
Under a given torque, as in the paper's own experiment, of which it says that the layer decreases
with the step size, the turn of a step is itself proportional to h^2.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from quasistatic_ref.figures import Figure, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.validate.measures import slope
from quasistatic_ref.lab.validate.paper.boundary_layer import LIMIT, layer_at_rate, layer_at_torque
from quasistatic_ref.step.data import Array

TIME_STEPS = np.geomspace(1e-3, 3e-2, 5)
"""h [s]."""


@cache
def layers() -> dict[str, Array]:
    """The layer that a sphere settles on, one number for each h, shape (N,) [m]."""
    return {
        "fixed rate": np.array([layer_at_rate(h) for h in TIME_STEPS]),
        "fixed torque": np.array([layer_at_torque(h, 2 * LIMIT) for h in TIME_STEPS]),
    }


def main() -> Numbers:
    """Exponents of h."""
    return {f"exponent of h at a {name} [-]": slope(TIME_STEPS, x) for name, x in layers().items()}


@styled
def figure() -> Figure:
    """Both laws."""
    page, (axes,) = panels(4.6, 2.8)
    for (name, layer), mark in zip(layers().items(), "os", strict=True):
        label = f"{name}: slope {slope(TIME_STEPS, layer):.2f}"
        axes.loglog(1e3 * TIME_STEPS, 1e6 * layer, marker=mark, label=label)
    axes.set(xlabel="time step h [ms]", ylabel=r"boundary layer [$\mu$m]")
    axes.set_title("friction pyramid", loc="right")
    axes.legend()
    return page


if __name__ == "__main__":
    script(main, figure)
