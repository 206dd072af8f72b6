"""The table of checks, on a scene and on a run: causes come before what comes of them."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor import added, grips, locks
from quasistatic_ref.optional.doctor.frame.start import Start
from quasistatic_ref.optional.doctor.frame.undecided import Undecided, failure
from quasistatic_ref.optional.doctor.start import falls, placed, points
from quasistatic_ref.optional.doctor.steps import backends, depths, flats, leaps, limits, rings
from quasistatic_ref.optional.doctor.task import passing, touching, waypoints
from quasistatic_ref.optional.doctor.typed import masses, units
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.simulator import Simulator

Check = Callable[[Any], Iterator[Finding | Undecided]]
"""A scene at its start, or a run at its end -> findings, and what could not be decided."""
OF_SCENE: tuple[Check, ...] = (
    units.long_step,
    units.long_shapes,
    units.large_mu_omega,
    masses.sizes_apart,
    masses.density,
    masses.centre,
    masses.inertia,
    units.friction,
    units.angle,
    placed.gravity,
    falls.unsupported,
    placed.penetration,
    falls.in_the_air,
    placed.inside,
    locks.guided,
    points.few_points,
    units.count,
)
OF_RUN: tuple[Check, ...] = (
    units.far_targets,
    limits.idle_columns,
    limits.targets_beyond,
    limits.beyond_effort,
    waypoints.late,
    waypoints.still,
    passing.through,
    placed.comes_inside,
    touching.idle,
    grips.lost,
    waypoints.short,
    locks.locked,
    depths.sunk,
    depths.crossed,
    rings.rings,
    leaps.leaps,
    limits.joints_beyond,
    falls.falling,
    backends.backend_failures,
    added.artifact,
    flats.flat_contact,
)
NO_STEPS: tuple[Check, ...] = (units.no_steps,)


def looked(checks: Iterable[Check], of: Start) -> tuple[list[Finding], str]:
    """The findings of each check, in order, and a line on checks that were not made.

    Whatever fails in a check costs what it would have found, and never the run.

    Parameters
    ----------
    checks : iterable of callable
        `OF_SCENE`, `OF_RUN` or `NO_STEPS`.
    of : Start or Run
        The scene at its start, or the run at its end.
    """
    found: list[Finding] = []
    skipped: dict[str, list[str]] = {}
    for check in checks:
        try:
            for one in check(of):
                if isinstance(one, Finding):
                    found.append(one)
                else:
                    skipped.setdefault(one.why, []).append(one.what)
        except Exception as error:
            skipped.setdefault(failure(error), []).append(check.__name__.replace("_", " "))
    return found, "; ".join(f"{', '.join(names)}: {why}" for why, names in skipped.items())


def scene_findings(simulator: Simulator, q: Array, force: Array | None = None) -> list[Finding]:
    """The findings on a scene that is to start at q, (n_q,), under a force, (n_v,) [N, N m]."""
    return looked(OF_SCENE, Start(simulator, q, force))[0]
