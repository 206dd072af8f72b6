"""What watches a run: before each step, after it, and at the end."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from numpy.typing import ArrayLike, NDArray

from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.target import JointTrack


class Recording(Protocol):
    """The part of a :class:`~quasistatic_ref.Recorder` that observers may read.

    Attributes
    ----------
    simulator : Simulator
    system : System
    start, q : ndarray, shape (n_q,)
        Where the run started, and where it is [m, rad, -].
    steps : int
        Number of steps so far.
    tracks : sequence of JointTrack
        What the targets follow, where the run knows.
    idle_columns : sequence of str
        Columns of the targets' table that drive nothing.

    Examples
    --------
    >>> class Watch(qr.Observer):
    ...     def before(self, recorder: qr.Recording):
    ...         print(recorder.steps, recorder.q[2].round(3))
    >>> run = qr.load_scenario("sphere_spin", steps=2).run(progress=False, observers=[Watch()])
    0 0.05
    1 0.05
    """

    simulator: Simulator
    system: System
    start: Array
    q: Array
    steps: int
    tracks: Sequence[JointTrack]
    idle_columns: Sequence[str]

    def noted(self, name: str) -> NDArray[Any]:
        """The numbers that an observer kept of each step, shape (steps, ...) [any unit]."""
        ...


class Observer:
    """An observer of a run; a subclass overrides the methods that it needs.

    Attributes
    ----------
    notes : tuple of str
        Names of what :meth:`after` returns.
    every_step : bool
        Whether :meth:`after` is called after each step, and not once for several, in less time.

    Examples
    --------
    >>> class Watch(qr.Observer):
    ...     def end(self, recorder, trajectory, interrupted):
    ...         print(recorder.steps, "steps")
    ...         return trajectory
    >>> run = qr.load_scenario("sphere_spin", steps=3).run(progress=False, observers=[Watch()])
    3 steps
    """

    notes: tuple[str, ...] = ()
    every_step: bool = False

    def before(self, recorder: Recording) -> None:
        """Before a step from `recorder.q`; a QuasistaticError that is raised here ends the run."""

    def after(
        self, recorder: Recording, results: Sequence[StepResult], arrays: StepArrays
    ) -> Mapping[str, ArrayLike]:
        """After a step, or several: numbers (steps, ...) [any unit] that are kept, None for NaN.

        They are no part of the trajectory; `recorder.noted` gives them to :meth:`end`.

        Parameters
        ----------
        recorder : Recording
            Which has counted these steps.
        results : sequence of StepResult
            Of the last steps.
        arrays : dict of str to ndarray
            What the recorder keeps of them, read-only, by the names of a trajectory [of the
            notation]; of q where each step has led; and ``motion``, J delta_q [m, m, m, rad].
        """
        return {}

    def end(self, recorder: Recording, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """Called at the end of a run, also of one that failed: may replace the trajectory."""
        return trajectory
