"""Numbers that are no friction coefficient, no angle, no count, and no steps at all."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.start import Start, table
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import ROUGH

MANY = 10
"""Times as many contacts as a pair has candidates [-] that no one means by k."""


def friction(start: Start) -> Iterator[Finding]:
    """A mu_v beyond that of anything, once for each table."""
    rough = {table(start, pair): pair.mu_v for pair in start.pairs if pair.mu_v > ROUGH}
    for name, mu_v in rough.items():
        yield Finding(
            "no friction coefficient",
            True,
            f"check mu_v of {name}",
            f"a friction coefficient is the ratio of two forces, of rubber on asphalt 1, and this "
            f"is {mu_v:g}",
            {"mu_v": mu_v},
        )


def angle(start: Start) -> Iterator[Finding]:
    """An rpy beyond a whole turn."""
    for body in start.system.bodies:
        largest = float(np.abs(body.rpy).max())
        if largest > 2 * np.pi:
            yield Finding(
                "no angle",
                True,
                f"check the unit of rpy of {body.name}",
                f"angles are in radians, {largest:g} rad are {np.degrees(largest):.4g} degrees, "
                f"and {largest:g} degrees are {np.radians(largest):.4g} rad",
                {"angle_rad": largest},
            )


def count(start: Start) -> Iterator[Finding]:
    """A k far beyond the points of its pairs, once for each table."""
    beyond = {table(start, pair): pair for pair in start.pairs if pair.k > MANY * pair.candidates}
    for name, pair in beyond.items():
        yield Finding(
            "no count",
            True,
            f"lower k of {name}",
            f"it is {pair.k}, and {pair.name} has {pair.candidates} points, all of which are "
            "contacts of every step",
            {"k": pair.k, "points": pair.candidates},
        )


def no_steps(start: Start) -> Iterator[Finding]:
    """A run of no steps."""
    yield Finding("no motion", True, "raise steps", "it is 0, and nothing happens", {"steps": 0})
