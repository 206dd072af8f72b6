"""Everything that can go wrong, under one root.

Two families matter to a caller: :class:`InputError` (something given is not usable; exit
status 2) and :class:`StepNotSolved` (a well-formed step got no trustworthy answer; exit
status 3). Each message is one plain sentence; each object carries the data behind it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quasistatic_ref.formats.plain import bits
from quasistatic_ref.formats.quoting import clipped, one_line, short_words, shown_value

if TYPE_CHECKING:
    from quasistatic_ref.certify.farkas import FarkasVector
    from quasistatic_ref.certify.optimality import Residuals
    from quasistatic_ref.step.data import Array, StepData


class QuasistaticError(Exception):
    """Root of every error that this package raises on purpose."""

    def __str__(self) -> str:
        return one_line(short_words(super().__str__()))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return bool(bits((self.args, vars(self))) == bits((other.args, vars(other))))

    def __hash__(self) -> int:
        return hash((type(self), self.args))

    def __reduce__(self) -> tuple[Any, ...]:
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
    """

    def __init__(
        self,
        problem: str,
        *,
        field: str | None = None,
        value: Any = None,
        file: str | Path | None = None,
    ) -> None:
        self.problem, self.field, self.value, self.file = problem, field, value, file
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
    """The numbers of a step are not usable: wrong shape, not finite, H not positive definite."""


class ModelError(InputError):
    """A URDF, or a coordinate of it, is not usable."""


class ContactError(InputError):
    """A contact pair is not usable, or its distance has no trustworthy normal."""


class ScenarioError(InputError):
    """A scenario contradicts itself or names something that does not exist."""


class BackendError(InputError):
    """The solver is unknown or not installed, or does not support what a call needs."""


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
    """

    def __init__(
        self,
        backend: str,
        status: str,
        step: StepData,
        accuracy: float,
        residuals: Residuals | None = None,
    ) -> None:
        self.backend, self.status, self.step = backend, status, step
        self.accuracy, self.residuals = accuracy, residuals
        super().__init__(
            f"{backend} did not solve the step ({status}; accuracy {accuracy:g}); "
            "try another backend, or look at the step itself"
        )


class StepInfeasible(StepNotSolved):
    """No displacement satisfies the rows of the step; this is proved, not a solver's opinion.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    farkas : FarkasVector
        The proof: a combination of the rows that reads 0 >= something positive.
    """

    def __init__(self, step: StepData, farkas: FarkasVector) -> None:
        super().__init__("exact", "infeasible", step, 0.0)
        self.farkas = farkas
        self.args = (
            f"the step has no solution: {farkas.in_words} (proved without rounding); "
            "widen these gaps, or let one of the bodies give way",
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
    """

    def __init__(self, step: StepData, delta_q: Array, length: float) -> None:
        super().__init__("exact", "ill-posed", step, 0.0)
        self.delta_q, self.length = delta_q, length
        self.args = (
            f"the exact optimum is {length:.0e} times longer than anything that the step asks for; "
            "its contacts contradict each other but for rounding; look for opposite normals",
        )


class LimitExceeded(StepNotSolved):
    """A run has gone where no step should be taken from.

    Parameters
    ----------
    problem : str
        What is beyond which limit, and the remedy.
    step : StepData
        The step that was not taken.
    """

    def __init__(self, problem: str, step: StepData) -> None:
        super().__init__("none", "limit exceeded", step, 0.0)
        self.args = (problem,)


class NotDifferentiable(QuasistaticError):
    """A derivative is needed where a step has none.

    Parameters
    ----------
    reasons : tuple
        Why, each in words as its text: at least one. The part that raises it says of what type.
    """

    def __init__(self, reasons: tuple[Any, ...]) -> None:
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
    file : Path, optional
        Where the trajectory was written.
    """

    def __init__(
        self,
        reason: str,
        trajectory: Any,
        step: StepData | None = None,
        file: Path | None = None,
    ) -> None:
        self.reason, self.trajectory, self.step, self.file = reason, trajectory, step, file
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
    kind: type[QuasistaticError], args: tuple[Any, ...], state: dict[str, Any]
) -> QuasistaticError:
    error = kind.__new__(kind, *args)
    error.args = args
    error.__dict__.update(state)
    return error
