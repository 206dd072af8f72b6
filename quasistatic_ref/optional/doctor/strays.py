"""Points of a cloud that are no part of its surface."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.start import Start, body
from quasistatic_ref.parts import if_there
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Array, Mask

FEWEST, MOST = 50, 200_000
"""Points of a cloud that is looked at: fewer have no surface, more take a second."""
SHOWN = 3


def strays(start: Start) -> Iterator[Finding]:
    """Clouds with points that no gap of a few spacings joins to the others."""
    clouds = {
        id(p.shape): (p.shape, body(start.system, p.link))
        for p in start.sides
        if isinstance(p.shape, PointCloud) and FEWEST <= len(p.shape.points) <= MOST
    }
    for shape, name in clouds.values():
        found = shape.points[_stray(shape.points)]
        if len(found):
            places = ["({:.4g}, {:.4g}, {:.4g})".format(*point) for point in 1e3 * found[:SHOWN]]
            more = ["..."] if len(found) > SHOWN else []
            yield Finding(
                "stray points",
                False,
                f"leave {len(found)} stray points out of the cloud of {name}, or make it by "
                "quasistatic-ref body",
                f"they lie at {', '.join(places + more)} mm, apart from the {len(shape.points)} "
                "points of its surface",
                {"strays": len(found)},
            )


def _stray(points: Array) -> Mask:
    """Which points, shape (N, 3) [m], no gap of a few spacings joins to the others."""
    with if_there():
        from quasistatic_ref.optional.scans.cloud import stray  # it loads SciPy: a second

        return stray(points)
    return np.zeros(len(points), dtype=bool)
