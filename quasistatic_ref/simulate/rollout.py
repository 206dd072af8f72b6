"""Steps in sequence: where a step becomes a trajectory."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

from quasistatic_ref.errors import QuasistaticError, RunFailed, StepNotSolved
from quasistatic_ref.progress import progress_bar
from quasistatic_ref.simulate.goals import Force, Target, force_function, target_function
from quasistatic_ref.simulate.interrupt import Interrupt
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import Simulator


def rollout(
    simulator: Simulator,
    q: Array,
    target: Target,
    steps: int,
    *,
    force: Force | None = None,
    record: str = "full",
    progress: bool = True,
) -> Trajectory:
    """Step after step, recorded.

    The step from t to t + h uses the target and the external force at t + h; where they are
    functions of (t, q), that is t + h as well, and q is where the step starts.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
        Where to start; quaternions are normalised.
    target : callable, or ndarray of shape (n_q_a,) or (steps, n_q_a)
        q_bar_a as a function of t [s] or of (t, q), constant, or step by step.
    steps : int
    force : callable, optional
        External generalised force, shape (n_v,) [N, N m], as a function of t or of (t, q).
    record : str
        ``"full"``, or ``"light"`` to leave out the quadratic programs.
    progress : bool
        Whether to show a progress bar on standard error, where that is a terminal, and to print
        there, at the end of a complete run, what it warns of
        (:attr:`~quasistatic_ref.simulate.trajectory.Trajectory.warnings`).

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        If the target or the force takes other arguments than these, or q is no configuration.
    RunFailed
        If a step fails, or Ctrl-C is pressed, which is answered between two steps; it holds the
        trajectory so far, and the failing step.
    """
    recorder = Recorder(simulator, q, record)
    q = recorder.q[0]
    q_bar_a = target_function(simulator.system, simulator.h, target, steps)
    pushed = force_function(simulator.system, force)
    bar: Iterable[int] = progress_bar(range(steps), unit="step", shown=progress)
    with Interrupt() as interrupt:
        for k in bar:
            t = recorder.t
            try:
                interrupt.check()
                goal = q_bar_a(t, q)
                result = simulator.step(q, goal, pushed(t, q))
            except (QuasistaticError, KeyboardInterrupt) as failure:
                interrupted = isinstance(failure, KeyboardInterrupt)
                reason = f"step {k}: {'interrupted' if interrupted else failure}"
                step = failure.step if isinstance(failure, StepNotSolved) else None
                raise RunFailed(reason, recorder.trajectory(reason), step) from failure
            recorder.add(goal, result)
            q = result.q
    trajectory = recorder.trajectory()
    if progress:
        for sentence in trajectory.warnings:
            print(f"quasistatic-ref: {sentence}", file=sys.stderr)
    return trajectory
