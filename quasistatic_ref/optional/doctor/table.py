"""The table of findings, before a run and after it: causes come before what comes of them."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from quasistatic_ref.optional.between import OF_TASK, Said
from quasistatic_ref.optional.doctor import (
    contradictions,
    drag,
    few_points,
    guides,
    leaps,
    left_out,
    numbers,
    placed,
    solving,
    strays,
    sunk,
    targets,
    unborne,
    units,
    unsupported,
)
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.simulator import SCENE_FINDINGS, Simulator
from quasistatic_ref.simulate.trajectory import TIME_FINDINGS, Trajectory
from quasistatic_ref.step.data import Array


class Kind(NamedTuple):
    """One line of the table.

    Parameters
    ----------
    name : str
    grave : bool
        Whether such a run is not what was meant.
    found : callable
        A scene at its start, a run at its end or its trajectory -> what there is to say of it.
    """

    name: str
    grave: bool
    found: Callable[..., Iterator[Said]]


OF_SCENE = (
    Kind("unit of a shape", True, units.long_shapes),
    Kind("unit of mu_omega", True, units.large_mu_omega),
    Kind("stray points", False, strays.strays),
    Kind("sizes apart", True, contradictions.sizes_apart),
    Kind("density", True, contradictions.density),
    Kind("centre of mass", True, contradictions.centre),
    Kind("inertia", True, contradictions.inertia),
    Kind("no friction coefficient", True, numbers.friction),
    Kind("no angle", True, numbers.angle),
    Kind("gravity", True, placed.gravity),
    Kind("unsupported body", True, unsupported.unsupported),
    Kind("unsupported body", True, placed.nothing_below),
    Kind("initial penetration", True, placed.penetration),
    Kind("starts in the air", True, placed.in_the_air),
    Kind("guided friction", True, guides.guided),
    Kind("too few points", True, few_points.few_points),
    Kind("no count", True, numbers.count),
)
OF_TARGETS = (
    Kind("unit of a target", True, units.far_targets),
    Kind("target beyond a limit", True, targets.beyond_limits),
)


def of_task() -> tuple[Kind, ...]:
    """What ``optional/account`` finds of a run's task, where it is there."""
    return tuple(Kind(name, grave, _of_task(name)) for name, grave in OF_TASK.found() or ())


def _of_task(name: str) -> Callable[[Run], Iterator[Said]]:
    return lambda run: run.task.found(name) if run.complete else iter(())


AFTER = (
    *OF_TARGETS,
    *of_task(),
    Kind("locked guide", True, guides.locked),
    Kind("sunk contact", True, sunk.sunk),
    Kind("leap", True, leaps.leaps),
    Kind("joint beyond a limit", True, targets.joints_beyond),
    Kind("half a turn behind", True, targets.half_turns),
    Kind("free fall", True, unsupported.falling),
    Kind("failing backend", True, solving.backend_failures),
    Kind("drag", False, drag.drag),
    Kind("border of k", False, left_out.border),
    Kind("exchanged points", False, left_out.exchanged),
    Kind("uncertain forces", False, unborne.unborne),
)
NO_STEPS = Kind("no motion", True, numbers.no_steps)
OF_TIME = (Kind("time of proof", False, solving.proofs),)
"""Of wall time, which is no part of a trajectory's file."""


def scene_findings(simulator: Simulator, q: Array) -> list[Finding]:
    """The findings on the scene of a simulator that is to start at q, shape (n_q,)."""
    return findings(OF_SCENE, Start(simulator, q))


def findings(kinds: Iterable[Kind], of: Start | Trajectory) -> list[Finding]:
    """What each line of a table finds, in its order.

    Parameters
    ----------
    kinds : iterable of Kind
        `OF_SCENE`, `AFTER` or `OF_TIME`.
    of : Start, Run or Trajectory
        The scene at its start, the run at its end, or the trajectory of a run that has steps.
    """
    return [
        Finding(kind.name, kind.grave, f"{said.remedy}: {said.cause}", said.remedy, said.numbers)
        for kind in kinds
        for said in kind.found(of)
    ]


SCENE_FINDINGS.fill(scene_findings)
TIME_FINDINGS.fill(lambda trajectory: findings(OF_TIME, trajectory))
