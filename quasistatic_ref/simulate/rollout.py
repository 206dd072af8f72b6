"""Steps in sequence: where a step becomes a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from quasistatic_ref.errors import InputError, QuasistaticError, RunFailed, StepNotSolved
from quasistatic_ref.formats.given import arguments_checked, checked_items
from quasistatic_ref.parts import Slot
from quasistatic_ref.simulate.interrupt import Interrupt
from quasistatic_ref.simulate.observer import Observer, doctors
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.simulate.user_functions import (
    Checked,
    Force,
    Target,
    force_function,
    target_function,
)
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from quasistatic_ref.simulate.result import StepResult
    from quasistatic_ref.simulate.simulator import Simulator

COLD_EVERY = 1000
"""Steps after which the solver starts cold.

What a solver keeps of earlier steps decides the last bits of multipliers, and of answers that are
not certified. A run that is resumed must take these steps again.
"""

SAVE_EVERY = 60.0
"""Time between two saves of the steps so far [s], unless another is given."""


class SavedRun(Protocol):
    """The saved steps of a run."""

    @property
    def lock(self) -> AbstractContextManager[object]:
        """Released when the run ends."""

    @property
    def written(self) -> Path:
        """Where its trajectory is."""


Given = Mapping[str, tuple[object, Checked]]
BEGUN_OR_RESUMED: Slot[
    Callable[[str | Path, float | None, bool, int, Recorder, Given, int], SavedRun]
] = Slot("runs.resume")
FIRST_STEP: Slot[Callable[[Path, int, bool], int]] = Slot("runs.saved_files")
"""Of a trajectory's file, its steps in all, and whether to resume: where a run begins."""
SAVED_STEPS: Slot[Callable[[Path], int]] = Slot("runs.saved_files")
"""How many steps are saved next to a trajectory's file."""


@arguments_checked
def rollout(
    simulator: Simulator,
    q: Array,
    target: Target,
    steps: int,
    *,
    force: Force | None = None,
    record: str = "full",
    progress: bool = True,
    save: str | Path | None = None,
    save_every: float | None = None,
    resume: bool = False,
    observers: Sequence[Observer] = (),
) -> Trajectory:
    """Step after step, recorded.

    The step from t to t + h uses the target and the external force at t + h; where they are
    functions of (t, q), that is t + h as well, and q is where the step starts. As functions of
    (t, q, last) they also get the result of the step before: None at the first step.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
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
        Whether to show a progress bar on standard error, where that is a terminal, and to print
        there, at the end of a run, its findings
        (:attr:`~quasistatic_ref.simulate.trajectory.Trajectory.findings`).
    save : str or Path, optional
        The trajectory's file, written when the run ends, also when it ends early: then next to it,
        as ``NAME_failed.npz``, if a longer run is there. While the run goes on, its steps are saved
        in a folder next to that file; see
        :class:`~quasistatic_ref.optional.runs.saved_files.SavedSteps`.
    save_every : float
        Time between two saves [s]; by default a minute.
    resume : bool
        Whether to go on from the steps that are saved there, if there are any. The result has the
        bits of a run that was never interrupted, if target and force are functions of (t, q) alone;
        functions of (t, q, last) are refused.
    observers : sequence of Observer
        What else watches the run: before each step, after it, and at the end.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        If the target or the force takes other arguments than these, q is no configuration, or steps
        no whole number; if
        the saved steps are of another run; if steps that are there would be lost, see
        :func:`~quasistatic_ref.optional.runs.saved_files.first_step`; if there is no
        ``optional/runs`` for `save`.
    RunFailed
        If a step fails, or Ctrl-C is pressed, which is answered between two steps; it holds the
        trajectory so far, and the failing step.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> run = qr.rollout(simulator, q, [], steps=3, progress=False)
    >>> len(run), run.phi.shape
    (3, (3, 1))
    """
    if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or steps < 0:
        raise InputError("must be a whole number, 0 or more", field="steps", value=steps)
    watching = checked_items(observers, Observer, "observers")
    recorder = Recorder(simulator, q, record, [*doctors(printed=progress), *watching])
    recorder.tracks = getattr(target, "tracks", ())
    q_bar_a_at = target_function(simulator.system, simulator.h, target, steps)
    force_at = force_function(simulator.system, force)
    saved = None
    if save is not None:
        given = {"target": (target, q_bar_a_at), "force": (force, force_at)}
        begun = BEGUN_OR_RESUMED.needed("save")
        saved = begun(save, save_every, resume, steps, recorder, given, COLD_EVERY)
    bar = progress_bar(unit="step", total=steps, done=recorder.steps, shown=progress)
    last: StepResult | None = None
    with nullcontext() if saved is None else saved.lock, Interrupt() as interrupt, bar:
        for k in range(recorder.steps, steps):
            if k % COLD_EVERY == 0:
                simulator.start_cold()
            try:
                interrupt.check()
                for observer in recorder.observers:
                    observer.before(recorder)
                q = recorder.q
                q_bar_a = q_bar_a_at(recorder.t, q, last)
                last = simulator.step(q, q_bar_a, force_at(recorder.t, q, last))
                recorder.add(q_bar_a, last)
                if recorder.steps == steps:
                    recorder.packed()
            except (QuasistaticError, KeyboardInterrupt) as failure:
                interrupted = isinstance(failure, KeyboardInterrupt)
                last_or_next = max(k, recorder.steps - 1)
                reason = f"step {last_or_next}: {'interrupted' if interrupted else failure}"
                step = failure.step if isinstance(failure, StepNotSolved) else None
                with suppress(QuasistaticError):  # of an observer: the run has failed already
                    recorder.packed()
                trajectory = recorder.trajectory(reason, interrupted)
                file = None if saved is None else saved.written
                raise RunFailed(reason, trajectory, step, file) from failure
            bar.update()
        return recorder.trajectory()
