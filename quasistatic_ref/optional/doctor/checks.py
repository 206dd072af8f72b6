"""The table of checks, on a scene and on a run: causes come before what comes of them."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor import (
    added,
    contradictions,
    grips,
    locks,
    placed,
    points,
    rings,
    solving,
    steps,
    targets,
    task,
    units,
    unsupported,
)
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.optional.doctor.undecided import Undecided, failure
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.simulator import Simulator


class Check(NamedTuple):
    """One check: the findings that it can give, and when it cannot be made.

    Parameters
    ----------
    findings : callable
        A scene at its start, a run at its end or its trajectory -> findings, and what it could not
        decide.
    unless : callable
        The same -> why this check does not look at it; nothing where it does.
    name : str
        What is not looked at then, where that is not plain.
    """

    findings: Callable[[Any], Iterator[Finding | Undecided]]
    unless: Callable[[Any], str] = lambda _: ""
    name: str = ""


def is_large(start: Start) -> str:
    """The reason why a scene is too large for checks that form J; empty if it is not."""
    return "" if start.small else "the scene is large"


def has_own_terms(run: Run) -> str:
    """The reason why the steps of a run are not asked by other laws; empty if there is none."""
    return "the user's own costs or constraints are not asked" if run.own_terms else ""


def is_cut_short(run: Run) -> str:
    """Why a run does not show whether a task was done; empty if it does."""
    return "" if run.complete else "the run ended early"


OF_SCENE = (
    Check(units.long_step),
    Check(units.long_shapes),
    Check(units.large_mu_omega),
    Check(contradictions.sizes_apart),
    Check(contradictions.density),
    Check(contradictions.centre),
    Check(contradictions.inertia),
    Check(units.friction),
    Check(units.angle),
    Check(placed.gravity),
    Check(unsupported.unsupported),
    Check(placed.penetration),
    Check(placed.in_the_air),
    Check(placed.inside),
    Check(locks.guided, is_large, "guides"),
    Check(points.few_points, is_large, "points of faces"),
    Check(units.count),
)
OF_RUN = (
    Check(units.far_targets),
    Check(targets.idle_columns),
    Check(targets.beyond_limits),
    Check(targets.beyond_effort),
    Check(task.late, is_cut_short),
    Check(task.still, is_cut_short),
    Check(task.through, is_cut_short),
    Check(task.idle, is_cut_short),
    Check(grips.lost, has_own_terms),
    Check(task.short, is_cut_short),
    Check(locks.locked, is_large, "locked guides"),
    Check(steps.sunk),
    Check(steps.crossed),
    Check(rings.rings),
    Check(steps.leaps),
    Check(targets.joints_beyond),
    Check(unsupported.falling),
    Check(solving.backend_failures),
    Check(added.artifact),
)
NO_STEPS = (Check(units.no_steps),)


def looked(checks: Iterable[Check], of: Start) -> tuple[list[Finding], str]:
    """The findings of each check, in order, and a line on checks that were not made.

    Whatever fails in a check costs what it would have found, and never the run.

    Parameters
    ----------
    checks : iterable of Check
        `OF_SCENE`, `OF_RUN` or `NO_STEPS`.
    of : Start or Run
        The scene at its start, or the run at its end.
    """
    every: list[Finding | Undecided] = []
    for check in checks:
        try:
            why = check.unless(of)
            every += [Undecided(check.name, why)] if why else check.findings(of)
        except Exception as error:
            name = check.name or check.findings.__name__.replace("_", " ")
            every.append(Undecided(name, failure(error)))
    skipped: dict[str, list[str]] = {}
    for what, why in (one for one in every if isinstance(one, Undecided) and one.what):
        skipped.setdefault(why, []).append(what)
    open_ones = "; ".join(f"{', '.join(names)}: {why}" for why, names in skipped.items())
    return [one for one in every if isinstance(one, Finding)], open_ones


def scene_findings(simulator: Simulator, q: Array, force: Array | None = None) -> list[Finding]:
    """The findings on a scene that is to start at q, (n_q,), under a force, (n_v,) [N, N m]."""
    return looked(OF_SCENE, Start(simulator, q, force))[0]
