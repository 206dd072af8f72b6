"""Numbers that look like another unit, or like nothing that is meant, and a run of no steps."""

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, friction_of, least, table
from quasistatic_ref.optional.doctor.tolerances import IN_METRES
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.simulate.finding import Finding

ROUGH: Final = 5.0
"""Friction coefficient above which a number is none [-]: racing tyres have 1.7."""

MANY = 10
"""Times as many contacts as a pair has candidates [-] that no one means by k."""
LONGEST = 1.0
"""Time step [s] above which milliseconds are meant: what hands move goes its whole way in it."""


def long_step(start: Start) -> Iterator[Finding]:
    """A time step of more than a second."""
    if start.h > LONGEST:
        yield Finding(
            "unit-of-h",
            True,
            "check the unit of h",
            f"times are in seconds, and a step of {start.h:g} s is one straight motion between "
            f"contacts that do not change; {start.h:g} ms are h = {start.h / 1e3:g}",
            {"h_s": start.h},
        )


def long_shapes(start: Start) -> Iterator[Finding]:
    """Meshes and clouds longer than anything that a robot meets: the longest is named."""
    shapes = [*start.system.shapes, *start.sides]
    modelled = {p.name: p.shape for p in shapes if isinstance(p.shape, PointCloud | ConvexMesh)}
    long = {name: x for name, shape in modelled.items() if (x := shape.extent) > IN_METRES}
    if long:
        name = max(long, key=long.__getitem__)
        others = f" ({len(long) - 1} more are as suspect)" if len(long) > 1 else ""
        yield Finding(
            "unit-of-a-shape",
            True,
            f"check the unit of {name}",
            f"lengths are in metres, and {name} is {long[name]:.3g} m long; scale it by 0.001 if "
            "that "
            f"is meant in millimetres{others}",
            {"length_m": long[name]},
        )


def large_mu_omega(start: Start) -> Iterator[Finding]:
    """mu_omega longer than the smaller body, once for each table of contacts or MuJoCo scene."""
    rough = [pair for pair in start.pairs if pair.mu_omega > least(pair)]
    for name, pair, others in _once(start, rough, lambda pair: pair.mu_omega / least(pair)):
        field = friction_of(start, "mu_omega", name)
        yield Finding(
            "unit-of-mu-omega",
            True,
            f"check the unit of {field}",
            f"{field} is a length in metres, and {pair.mu_omega:.3g} m is more than the size of "
            f"the smaller body, {least(pair):.3g} m{others}",
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
                    "unit-of-a-target",
                    True,
                    f"check the unit of the targets of {joint.name}",
                    f"lengths are in metres, and the target of {joint.name} in step {k} is "
                    f"{length[k]:.3g} m",
                    {"length_m": float(length[k]), "step": k},
                )


def friction(start: Start) -> Iterator[Finding]:
    """A mu_v larger than any real one, once for each table or MuJoCo scene."""
    rough = [pair for pair in start.pairs if pair.mu_v > ROUGH]
    for name, pair, others in _once(start, rough, lambda pair: pair.mu_v):
        field = friction_of(start, "mu_v", name)
        yield Finding(
            "no-friction-coefficient",
            True,
            f"check {field}",
            f"a friction coefficient is the ratio of two forces, of rubber on asphalt 1, and "
            f"{field} is {pair.mu_v:g}{others}",
            {"mu_v": pair.mu_v},
        )


def _once(
    start: Start, rough: list[ContactPair], excess: Callable[[ContactPair], float]
) -> Iterator[tuple[str, ContactPair, str]]:
    """The last pair of each table, or the worst of a MuJoCo scene, with words on the others.

    A MuJoCo scene has a pair for any two geoms that may touch, and one default for their friction.
    """
    if start.system.of_mjcf and rough:
        worst = max(rough, key=excess)
        others = f" ({len(rough) - 1} more pairs are as suspect)" if len(rough) > 1 else ""
        yield table(start, worst), worst, others
        return
    yield from ((name, pair, "") for name, pair in {table(start, p): p for p in rough}.items())


def angle(start: Start) -> Iterator[Finding]:
    """An rpy beyond a whole turn."""
    for body in start.system.bodies:
        largest = float(np.abs(body.rpy).max())
        if largest > 2 * np.pi:
            yield Finding(
                "no-angle",
                True,
                f"check the unit of rpy of {body.name}",
                f"angles are in radians: the {largest:g} rad in rpy of {body.name} are "
                f"{np.degrees(largest):.4g} degrees, "
                f"and {largest:g} degrees are {np.radians(largest):.4g} rad",
                {"angle_rad": largest},
            )


def count(start: Start) -> Iterator[Finding]:
    """A k far beyond the points of its pairs, once for each table."""
    beyond = {table(start, pair): pair for pair in start.pairs if pair.k > MANY * pair.candidates}
    for name, pair in beyond.items():
        yield Finding(
            "no-count",
            True,
            f"lower k of {name}",
            f"k of {name} is {pair.k}, and {pair.name} has {pair.candidates} points, all of "
            "which are "
            "contacts of every step",
            {"k": pair.k, "points": pair.candidates},
        )


def no_steps(start: Start) -> Iterator[Finding]:
    """The finding of a run whose `steps` is 0."""
    yield Finding("no-motion", True, "raise steps", "steps is 0, and nothing happens", {"steps": 0})
