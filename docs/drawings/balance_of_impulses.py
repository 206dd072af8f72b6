"""Impulses on a block that is pushed with 6 N: load and contact add up to M delta_q / h."""

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from docs.drawings.the_program import GRAVITY, MASS, H, point
from quasistatic_ref import solve_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

PUSH = 6.0  # N


def impulses() -> dict[str, np.ndarray]:
    """Impulses of load, contact and motion, each (along the push, up) [N s]."""
    solution = solve_step(point(PUSH))
    load = H * np.array([PUSH, -MASS * GRAVITY])
    contact = H * solution.wrench[0, [0, 2]]
    momentum = MASS * solution.delta_q / H
    assert np.allclose(load + contact, momentum, rtol=0, atol=1e-12)
    return {r"$h\,\tau_u$": load, r"$A^T\lambda$": contact, r"$M_u\,\delta q / h$": momentum}


def figure() -> Figure:
    """Load and contact one after the other, and what is left."""
    page, (axes,) = panels(5.6, 3.0)
    start = np.zeros(2)
    looks = (("0.3", 2.0), ("#0072B2", 2.0), ("#D55E00", 2.6))
    for (name, impulse), (colour, width) in zip(impulses().items(), looks, strict=True):
        tail = np.zeros(2) if "M_u" in name else start
        look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "color": colour}
        axes.annotate(
            "", 1e3 * (tail + impulse), 1e3 * tail, arrowprops=look | {"linewidth": scaled(width)}
        )
        axes.plot([], [], color=colour, linestyle="-", linewidth=scaled(width), label=name)
        start = start + impulse
    axes.plot(0, 0, "o", color="black", markersize=scaled(4))
    axes.set(xlim=(-20, 90), ylim=(-110, 25))
    label_axes(axes, "along the push [mN s]", "up [mN s]", key=False)
    legend_below([axes], axes.get_legend_handles_labels()[0])
    return page
