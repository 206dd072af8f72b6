"""Everything that can go wrong, under one root.

Two families matter to a caller: :class:`InputError` (something given is not usable; exit
status 2) and :class:`StepNotSolved` (a well-formed step got no trustworthy answer; exit
status 3). Each message is one plain sentence; each object carries the data behind it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from quasistatic_ref.formats.plain import bits
from quasistatic_ref.formats.quoting import clipped, one_line, short_words, shown_value

if TYPE_CHECKING:
    from quasistatic_ref.certify.farkas import FarkasVector
    from quasistatic_ref.certify.residuals import Residuals
    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.solve.solver import NaturalAnswer
    from quasistatic_ref.step.data import Array, StepData


class QuasistaticError(Exception):
    """Root of every error that this package raises on purpose.

    Examples
    --------
    >>> try:
    ...     qr.load_scenario("no_such_scene")
    ... except qr.QuasistaticError as error:
    ...     print(type(error).__name__)
    ScenarioError
    """

    def __str__(self) -> str:
        return one_line(short_words(super().__str__()))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return bool(bits((self.args, vars(self))) == bits((other.args, vars(other))))

    def __hash__(self) -> int:
        return hash((type(self), self.args))

    def __reduce__(self) -> tuple[object, ...]:
        # Exceptions are rebuilt from `args`, which here hold the message only.
        return _rebuilt, (type(self), self.args, self.__dict__)


class InputError(QuasistaticError):
    """Something given by the user cannot be used.

    Parameters
    ----------
    problem : str
        What is wrong and what would be right, as the end of a sentence.
    field : str, optional
        Name of the offending field, e.g. ``contacts.grip.mu_v``.
    value : object, optional
        The offending value.
    file : str or Path, optional
        The file that it stands in.

    Examples
    --------
    >>> try:
    ...     qr.Sphere(-0.01)
    ... except qr.InputError as error:
    ...     print(error)
    radius: must be a positive length (got -0.01)
    """

    def __init__(
        self,
        problem: str,
        *,
        field: str | None = None,
        value: object = None,
        file: str | Path | None = None,
    ) -> None:
        self.problem = problem
        self.field = field
        self.value = value
        self.file = file
        super().__init__(problem)

    def __str__(self) -> str:
        where = f"{clipped(str(self.file))}: " if self.file is not None else ""
        what = f"{clipped(self.field)}: " if self.field is not None else ""
        got = f" (got {shown_value(self.value)})" if self.value is not None else ""
        return one_line(f"{where}{what}{short_words(self.problem)}{got}")

    def in_file(self, file: str | Path) -> InputError:
        """Return the same error, saying which file it is about (unless it says so already)."""
        if self.file is None:
            self.file = file
        return self


class StepDataError(InputError):
    """The numbers of a step are not usable: wrong shape, not finite, H not positive definite.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> try:
    ...     step.replace(h=-0.02)
    ... except qr.StepDataError as error:
    ...     print(error)
    h: must be a positive number of seconds (got -0.02)
    """


class ModelError(InputError):
    """A URDF, or a coordinate of it, is not usable.

    Examples
    --------
    >>> try:
    ...     qr.Sphere(-0.01)
    ... except qr.ModelError as error:
    ...     print(error)
    radius: must be a positive length (got -0.01)
    """


class ContactError(InputError):
    """A contact pair is not usable, or its distance has no trustworthy normal.

    Examples
    --------
    >>> ball = qr.PlacedShape("ball", link=0, R=np.eye(3), t=np.zeros(3), shape=qr.Sphere(0.05))
    >>> try:
    ...     qr.ContactPair("twice", ball, ball, mu_v=0.3, mu_omega=0.0, rows=4, k=1)
    ... except qr.ContactError as error:
    ...     print(error)
    twice: both shapes are fixed to the same link
    """


class ScenarioError(InputError):
    """A scenario contradicts itself or names something that does not exist.

    Examples
    --------
    >>> try:
    ...     qr.load_scenario("sphere_spin", {"contacts.floor.mu_w": 0})
    ... except qr.ScenarioError as error:
    ...     print(error.field)
    contacts.floor.mu_w
    """


class BackendError(InputError):
    """The solver is unknown or not installed, or does not support what a call needs.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> try:
    ...     qr.solve_step(step, "clarabell")
    ... except qr.BackendError as error:
    ...     print(error.field, error.value)
    backend clarabell
    """


class StepNotSolved(QuasistaticError):
    """A solver gave no answer that can be trusted.

    Carries everything that is needed to replay the step.

    Parameters
    ----------
    backend : str
        Name in the table of backends.
    status : str
        What the solver said, or why its answer was not taken.
    step : StepData
        The step in SI units, as given.
    accuracy : float
        The accuracy of the call, in natural units [-].
    residuals : Residuals, optional
        Residuals of the refused answer, where there was one.

    Attributes
    ----------
    unclaimed : NaturalAnswer or None
        The backend's last answer, which it does not call a full solution.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> walls = qr.Extra(names=("up", "down"), A=np.eye(6)[2] * [[1], [-1]], b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepNotSolved as error:
    ...     print(error.status, error.step.n_v)
    infeasible 6
    """

    def __init__(
        self,
        backend: str,
        status: str,
        step: StepData,
        accuracy: float,
        residuals: Residuals | None = None,
    ) -> None:
        self.backend = backend
        self.status = status
        self.step = step
        self.accuracy = accuracy
        self.residuals = residuals
        self.unclaimed: NaturalAnswer | None = None
        super().__init__(
            f"{backend} did not solve the step ({status}; accuracy {accuracy:g}); "
            "try another backend, or check the step"
        )


class StepInfeasible(StepNotSolved):
    """No displacement satisfies the rows of the step; this is proved, not a solver's opinion.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    farkas : FarkasVector
        The proof: a combination of the rows that reads 0 >= something positive.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> walls = qr.Extra(names=("up", "down"), A=np.eye(6)[2] * [[1], [-1]], b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepInfeasible as error:
    ...     print(error.status)
    infeasible
    """

    def __init__(self, step: StepData, farkas: FarkasVector) -> None:
        super().__init__("exact", "infeasible", step, 0.0)
        self.farkas = farkas
        self.args = (
            f"the step has no solution: {farkas.in_words} (proved without rounding); "
            "widen these gaps, or make one of the bodies compliant",
        )


class StepIllPosed(StepNotSolved):
    """The exact optimum is known and absurd: the rows contradict each other but for rounding.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    delta_q : ndarray, shape (n_v,)
        The exact optimum [m, rad], correctly rounded.
    length : float
        Its length in the H norm, over the largest that the loads or a row ask for alone [-].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> A = [[1, 0, 0, 0, 0, 0], [-1, 1e-12, 0, 0, 0, 0]]  # opposite but for 1e-12
    >>> walls = qr.Extra(names=("left", "right"), A=A, b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepIllPosed as error:
    ...     print(error.length > 1e6)
    True
    """

    def __init__(self, step: StepData, delta_q: Array, length: float) -> None:
        super().__init__("exact", "ill-posed", step, 0.0)
        self.delta_q = delta_q
        self.length = length
        self.args = (
            f"the exact optimum is {length:.0e} times longer than the step's forces, targets and "
            "gaps explain, because its contacts almost contradict each other; look for opposite "
            "normals",
        )


class LimitExceeded(StepNotSolved):
    """A run has gone where no step should be taken from.

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
    >>> storm = qr.Simulator(system, [], h=0.01, K_q=np.zeros((0, 0)), gravity=(0, 0, -1e7))
    >>> try:
    ...     storm.step(system.q_start, np.zeros(0))
    ... except qr.LimitExceeded as error:
    ...     print(error.status)
    limit exceeded
    """

    def __init__(self, problem: str, step: StepData) -> None:
        super().__init__("none", "limit exceeded", step, 0.0)
        self.args = (problem,)


class NoFixedPoint(StepNotSolved):
    """No solution of the step under Coulomb's law was found, which does not say that none exists.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    iterations : int
        Convex steps that were solved.
    residual : float
        By how much s is not that of the last one's slip [m].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.NoFixedPoint(step, 200, 1e-6).status
    'no fixed point'
    """

    def __init__(self, step: StepData, iterations: int, residual: float) -> None:
        super().__init__("coulomb", "no fixed point", step, 0.0)
        self.iterations = iterations
        self.residual = residual
        self.args = (
            f"no solution under Coulomb's law was found in {iterations} iterations, which does not "
            f"say that there is none: s is still off by {residual:.3g} m; take a smaller h, or "
            'law = "convex"',
        )


class NotDifferentiable(QuasistaticError):
    """A derivative is needed where a step has none.

    Parameters
    ----------
    reasons : tuple
        Why, each in words as its text: at least one. The part that raises it says of what type.

    Examples
    --------
    >>> print(qr.NotDifferentiable(("row +d1 of floor bears no load",)))
    the step has no derivative here: row +d1 of floor bears no load
    """

    def __init__(self, reasons: tuple[object, ...]) -> None:
        self.reasons = reasons
        more = f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else ""
        super().__init__(f"the step has no derivative here: {reasons[0]}{more}")


class RunFailed(QuasistaticError):
    """A simulation ended early; the steps before the failure are kept.

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
    >>> storm = qr.Simulator(system, [], h=0.01, K_q=np.zeros((0, 0)), gravity=(0, 0, -1e7))
    >>> try:
    ...     qr.rollout(storm, system.q_start, [], steps=3, progress=False)
    ... except qr.RunFailed as error:
    ...     print(len(error.trajectory))
    0
    """

    def __init__(
        self,
        reason: str,
        trajectory: Trajectory,
        step: StepData | None = None,
    ) -> None:
        self.reason = reason
        self.trajectory = trajectory
        self.step = step
        super().__init__(reason)


@contextmanager
def about_file(file: str | Path) -> Iterator[None]:
    """Make an InputError of this block say which file it is about, unless it says so already."""
    try:
        yield
    except InputError as error:
        raise error.in_file(file) from None


@contextmanager
def about_field(field: str) -> Iterator[None]:
    """Make an InputError of this block name that field of a file, and not what it was read into."""
    try:
        yield
    except InputError as error:
        error.field = field
        raise


def _rebuilt(
    kind: type[QuasistaticError], args: tuple[object, ...], state: dict[str, object]
) -> QuasistaticError:
    error = kind.__new__(kind, *args)
    error.args = args
    error.__dict__.update(state)
    return error
