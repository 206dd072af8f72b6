"""A run that ends early: at a limit, or at any error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.step.data import StepData
from quasistatic_ref.text.module_on_demand import ModuleOnDemand

if TYPE_CHECKING:
    from quasistatic_ref.simulate.record import trajectory as record
else:  # it needs pinocchio, which the commands of single steps do without
    record = ModuleOnDemand("quasistatic_ref.simulate.record.trajectory")


class LimitExceeded(StepNotSolved):
    """A run has reached a limit of penetration or distance, beyond which no step is taken.

    Parameters
    ----------
    problem : str
        What is beyond which limit, and the remedy.
    step : StepData
        The step that was not taken.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> system = qr.System([ball])
    >>> storm = qr.Simulator(system, [], h=0.01, gravity=(0, 0, -1e7))
    >>> try:
    ...     storm.step(system.q_start)
    ... except qr.LimitExceeded as error:
    ...     print(error.status)
    limit exceeded
    """

    def __init__(self, problem: str, step: StepData) -> None:
        super().__init__("none", "limit exceeded", step, 0.0)
        self.args = (problem,)


class RunFailed(QuasistaticError):
    """A simulation ended early; it carries the steps before the failure.

    The command line writes these to files (``failed_run`` of ``cli/options.py``).

    Parameters
    ----------
    reason : str
        One sentence.
    trajectory : Trajectory
        The steps that were completed, marked with the reason.
    step : StepData, optional
        The step that failed.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> system = qr.System([ball])
    >>> storm = qr.Simulator(system, [], h=0.01, gravity=(0, 0, -1e7))
    >>> try:
    ...     qr.rollout(storm, system.q_start, [], steps=3, progress=False)
    ... except qr.RunFailed as error:
    ...     print(error.trajectory.steps)
    0
    """

    def __init__(
        self,
        reason: str,
        trajectory: record.Trajectory,
        step: StepData | None = None,
    ) -> None:
        self.reason = reason
        self.trajectory = trajectory
        self.step = step
        super().__init__(reason)
