"""Steps in sequence: where a step becomes a trajectory."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.errors import InputError, QuasistaticError, check_kind, keywords_named
from quasistatic_ref.simulate.finding import check_finding_name
from quasistatic_ref.simulate.interrupt import Interrupt
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.header import Record
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.recorder import Recorder, doctors
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.user_functions import (
    Force,
    Target,
    force_function,
    target_function,
)


@keywords_named
def rollout(
    simulator: Simulator,
    q: ArrayLike,
    target: Target,
    steps: int,
    *,
    force: Force | None = None,
    record: Record = "full",
    progress: bool = True,
    findings: bool = True,
    ignore: Sequence[str] = (),
    observers: Sequence[Observer] = (),
) -> Trajectory:
    """Take steps in sequence and return them as a trajectory.

    The step from t to t + h uses the target and the external force at t + h; where they are
    functions of (t, q), that is t + h as well, and q is where the step starts. As functions of
    (t, q, last) they also get the result of the step before: None at the first step.

    Parameters
    ----------
    simulator : Simulator
    q : array_like, shape (n_q,)
        Where to start; quaternions are normalised.
    target : callable, ndarray of shape (n_q_a,) or (steps, n_q_a), or mapping
        q_bar_a as a function of t [s], of (t, q) or of (t, q, last), constant, or step by step; or
        by names, as ``{"thumb": 0.01}``, all others as at the start.
    steps : int
    force : callable or ndarray of shape (n_v,), optional
        External generalised force [N, N m], as a function of the same or constant;
        :meth:`~quasistatic_ref.model.system.System.load` makes it.
    record : str
        ``"full"``; ``"light"`` to leave out the quadratic programs; ``"forces"`` to have the forces
        of single contacts in their place.
    progress : bool
        Whether to show a progress bar on a terminal or in a notebook.
    findings : bool
        Whether to print there, at the end of a run, its
        :attr:`~quasistatic_ref.simulate.record.trajectory.Trajectory.findings`. Findings that are
        not printed are looked for when they are first read, saved or pickled.
    ignore : sequence of str
        Names of findings that are neither printed nor in the trajectory's `findings`, but in its
        :attr:`~quasistatic_ref.simulate.record.trajectory.Trajectory.ignored_findings`.
    observers : sequence of Observer
        What else watches the run: before each step, after it, and at the end.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        If the target or the force takes other arguments than these, q is no configuration, steps no
        whole number, or a name to ignore none of a finding.
    RunFailed
        If a step fails, or Ctrl-C, SIGTERM or SIGHUP end it, which is answered between two steps;
        it holds the trajectory so far, and the failing step.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> run = qr.rollout(simulator, q, [], steps=3, progress=False)
    >>> run.steps, run.phi.shape
    (3, (3, 1))
    """
    if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or steps < 0:
        raise InputError("must be a whole number, 0 or more", field="steps", value=steps)
    check_kind(ignore, Iterable, "ignore", "a list of names")
    check_kind(observers, Iterable, "observers", "a list of Observer")
    for name in ignore:
        check_finding_name(name)
    watch = [*doctors(findings, ignore), *observers]
    recorder = Recorder(simulator, q, record, watch, target)
    q_bar_a_at = target_function(simulator.system, simulator.h, target, steps)
    force_at = force_function(simulator.system, force)
    simulator.start_cold()
    last: StepResult | None = None
    bar = progress_bar(unit="step", total=steps, shown=progress)
    with Interrupt() as interrupt, bar:
        for k in range(steps):
            try:
                interrupt.check()
                for observer in recorder.observers:
                    observer.before(recorder)
                q = recorder.q
                q_bar_a = q_bar_a_at(recorder.t, q, last)
                start = q if last is None else last.end
                last = simulator.step(start, q_bar_a, force_at(recorder.t, q, last))
                recorder.add(q_bar_a, last)
                if recorder.steps == steps:
                    recorder.flush()
            except (QuasistaticError, KeyboardInterrupt) as failure:
                interrupted = isinstance(failure, KeyboardInterrupt)
                last_or_next = max(k, recorder.steps - 1)
                reason = f"step {last_or_next}: {str(failure) or 'interrupted'}"
                step = failure.step if isinstance(failure, StepNotSolved) else None
                with suppress(QuasistaticError):  # of an observer: the run has failed already
                    recorder.flush()
                trajectory = recorder.trajectory(reason, interrupted)
                raise RunFailed(reason, trajectory, step) from failure
            bar.update()
        return recorder.trajectory()
