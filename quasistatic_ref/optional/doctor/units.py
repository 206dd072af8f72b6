"""Lengths that look like millimetres: of meshes and clouds, of mu_omega, and of targets."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, least, table
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import IN_METRES


def long_shapes(start: Start) -> Iterator[Finding]:
    """Meshes and clouds longer than anything that a robot meets: the longest is named."""
    shapes = [*start.system.shapes, *start.sides]
    modelled = {p.name: p.shape for p in shapes if isinstance(p.shape, PointCloud | ConvexMesh)}
    long = {name: x for name, shape in modelled.items() if (x := shape.extent) > IN_METRES}
    if long:
        name = max(long, key=long.__getitem__)
        others = f" ({len(long) - 1} more are as suspect)" if len(long) > 1 else ""
        yield Finding(
            "unit of a shape",
            True,
            f"check the unit of {name}",
            f"lengths are in metres, and it is {long[name]:.3g} m long; scale it by 0.001 if that "
            f"is meant in millimetres{others}",
            {"length_m": long[name]},
        )


def large_mu_omega(start: Start) -> Iterator[Finding]:
    """mu_omega longer than the smaller body, once for each table of contacts."""
    rough = [pair for pair in start.pairs if pair.mu_omega > least(pair)]
    for name, pair in {table(start, pair): pair for pair in rough}.items():
        yield Finding(
            "unit of mu_omega",
            True,
            f"check the unit of mu_omega of {name}",
            f"it is a length in metres, and {pair.mu_omega:.3g} m is more than the size of the "
            f"smaller body, {least(pair):.3g} m",
            {"mu_omega_m": pair.mu_omega, "size_m": least(pair)},
        )


def far_targets(run: Run) -> Iterator[Finding]:
    """Targets farther away than anything that a robot reaches."""
    for joint in run.system.joints:
        if joint.actuated:
            value = run["q_bar_a"][:, joint.q]
            length = np.abs(value[:, : joint.lengths]).max(axis=1, initial=0.0)
            k = int(length.argmax())
            if length[k] > IN_METRES:
                yield Finding(
                    "unit of a target",
                    True,
                    f"check the unit of the targets of {joint.name}",
                    f"lengths are in metres, and that of step {k} is {length[k]:.3g} m",
                    {"length_m": float(length[k]), "step": k},
                )
