"""How the boundary layer shrinks with the time step: like h at a rate, like h^2 at a torque.

The paper calls the layer proportional to h. So it is where the motion is imposed, mu_omega h omega.
Under a given torque, as in the paper's own experiment, of which it says that the layer decreases
with the step size, the turn of a step is itself proportional to h^2.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers, script
from quasistatic_ref.lab.figures.labels import labelled
from quasistatic_ref.lab.measures import slope
from quasistatic_ref.lab.scenes.spun_sphere import LIMIT, layer_at_rate, layer_at_torque
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.step.data import Array

TIME_STEPS = tuple(np.geomspace(1e-3, 3e-2, 5).tolist())
"""h [s]."""


@cache
def layers(h: tuple[float, ...] = TIME_STEPS, share: float = 2.0) -> dict[str, Array]:
    """The layer that a sphere settles on, one number for each h, shape (N,) [m].

    Parameters
    ----------
    h : tuple of float
        [s].
    share : float
        Of the fixed torque over mu_omega m g [-].
    """
    return {
        "fixed rate": np.array([layer_at_rate(x) for x in h]),
        "fixed torque": np.array([layer_at_torque(x, share * LIMIT) for x in h]),
    }


def main() -> Numbers:
    """Exponents of h."""
    return {f"exponent of h at a {name} [-]": slope(TIME_STEPS, x) for name, x in layers().items()}


def figure(ax: Any = None, *, h: Sequence[float] = TIME_STEPS, share: float = 2.0) -> Figure:
    """Both laws.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    h : sequence of float
        Time steps [s].
    share : float
        Of the fixed torque over mu_omega m g [-].
    """
    page, (axes,) = panels(4.6, 2.8, within=ax)
    for (name, layer), mark in zip(layers(tuple(h), share).items(), "os", strict=True):
        label = f"{name}: slope {slope(h, layer):.2f}"
        axes.loglog(1e3 * np.array(h), 1e6 * layer, marker=mark, label=label)
    labelled(axes, "time step h [ms]", r"boundary layer [$\mu$m]", "friction pyramid")
    return page


if __name__ == "__main__":
    script(main, figure)
