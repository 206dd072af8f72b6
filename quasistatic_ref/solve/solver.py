"""A solver of steps: one object that holds a compiled problem, and says what it is.

It knows its backend (``name``), by which interface it calls that (``interface``), and the kind of
step that its problem was compiled for (:meth:`Solver.fits`). Each interface is one class in a file
of its own, and :func:`~quasistatic_ref.solve.choice.solver_for` chooses among them.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from quasistatic_ref.certify.optimum import ProofCache
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, Mask, all_finite
from quasistatic_ref.quoting import one_line
from quasistatic_ref.solve.backends import (
    BACKENDS,
    UNSAFE,
    Options,
    backend,
    bare,
    greeting_silenced,
)
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, differences

ALIKE: Final = 1e3
"""Largest ratio of the lengths of a step's rows, in natural units [-], at which a solver is called
that may not return. On rows of very different lengths HiGHS 1.16 may end the process; the steps of
the scenarios in models/ stay below 3."""

FREE = "not called: the step has no rows"
"""Status of a step that is H delta_q = g."""


@dataclass(eq=False)
class Reply:
    """The unchecked answer of a solver; that to a step is in natural units.

    Parameters
    ----------
    x : ndarray, shape (n,), or None
        The answer to min 1/2 x'Hx - g'x, A x >= b; any shape if the solver is broken.
    lam : ndarray, shape (m,), or None
        Multipliers of A x >= b, >= 0 but for the solver's tolerance.
    solved : bool
        Whether it claims a full solution.
    status : str
        Its own word, or what it raised.
    iterations : int or None
    seconds, setup : float or None
        Of solving and of setting up [s], by the solver's own account, where it gives one.
    call_seconds : float
        Of the whole call [s], in a study.
    accuracy : float
        That the solver was asked for in this call, in natural units [-].
    asked : bool
        Whether the solver was asked at all.
    cause : Exception or None
        What another package raised, where that is why there are no numbers.
    """

    x: Array | None
    lam: Array | None
    solved: bool
    status: str
    iterations: int | None = None
    seconds: float | None = None
    call_seconds: float = 0.0
    setup: float | None = None
    accuracy: float = 0.0
    asked: bool = True
    cause: Exception | None = None

    @property
    def point(self) -> tuple[Array, Array]:
        """The solver's x (n,) and multipliers lam (m,) [-]; None unless it gave both."""
        assert self.x is not None
        assert self.lam is not None
        return self.x, self.lam


def check_not_interrupted(status: str) -> None:
    """Raise KeyboardInterrupt if a solver's status says that Ctrl-C ended it."""
    if status.lower().startswith("interrupted"):
        raise KeyboardInterrupt


class Solver(ABC):
    """A solver of steps that have the same sizes, cone and friction.

    A copy, or one that was pickled, compiles its problem again and starts cold.

    Parameters
    ----------
    template : StepData
        A step of that kind.
    name : str
        Of the backend.

    Attributes
    ----------
    interface : str
        By which the backend is called: ``"cvxpy"``, ``"qpsolvers"``, ``"native"`` or ``"none"``.
    fixed : tuple of str
        What the steps that it solves have in common, of ``KIND`` of ``step/data.py``.
    remembers : bool
        Whether its answer to a step may depend on the steps before.
    gives_basic_rows : bool
        Whether the rows of its positive multipliers are independent.
    bare_name : str
        Of the backend, without the interface.
    unsafe : bool
        Whether its backend may not return from steps whose rows are unlike each other.
    proofs : ProofCache
        Those of the last step.
    """

    interface: ClassVar[str]
    fixed: ClassVar[tuple[str, ...]]
    remembers: ClassVar[bool] = False
    gives_basic_rows: ClassVar[bool] = False

    def __init__(self, template: StepData, name: str) -> None:
        self.template = template
        self.name = name
        self.proofs = ProofCache()
        self.bare_name = bare(name)
        self.unsafe = self.bare_name in UNSAFE
        if self.bare_name == "highs":
            greeting_silenced()
        self._option_sets: dict[float, list[tuple[float, Options]]] = {}

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.template, self.name)

    def fits(self, step: StepData) -> bool:
        """Whether a step is of the kind that the problem was compiled for."""
        formed = step.formed
        alike = formed is not None and formed.is_like(self.template.formed)
        return alike or not self.differences(step)

    def check(self, step: StepData) -> None:
        """Refuse a step of another kind.

        Raises
        ------
        InputError
            Naming what differs.
        """
        if not self.fits(step):
            what = ", ".join(self.differences(step))
            problem = f"was made for steps that differ from this one in {what}; make a new solver"
            raise InputError(problem, field="backend", value=f"{self.name}, {self.interface}")

    def differences(self, step: StepData) -> list[str]:
        """Names of the fields in which a step differs from the one the problem was compiled for."""
        return differences(self.template, step, self.fixed)

    @abstractmethod
    def reply(self, natural: NaturalStep, accuracy: float) -> Reply:
        """The backend's reply to a step; its numbers are finite, or there are none.

        Rows out of reach bear no load. A backend that may not return is not called where the rows
        of the step are unlike each other.

        Parameters
        ----------
        natural : NaturalStep
        accuracy : float
            In natural units [-].
        """


class BackendSolver(Solver):
    """A solver that writes steps into a problem of a backend, and reads its replies."""

    @abstractmethod
    def write(self, natural: NaturalStep) -> Mask | None:
        """Write a step into the problem, in natural units.

        Gaps of contacts, and ends of a user's own rows, that are out of reach are written nearer
        than they are: numbers of very different size cost solvers digits. Such rows are inactive,
        and their multipliers are set to zero.

        Returns
        -------
        ndarray of bool, shape (m,), or None
            Which rows these are; None if none is.
        """

    @abstractmethod
    def reply_with(self, options: Options, natural: NaturalStep) -> Reply:
        """The backend's reply to the problem as it is written, with options in its own names."""

    def option_sets(self, accuracy: float) -> list[tuple[float, Options]]:
        """Accuracies in natural units [-] with options, in the order in which they are tried."""
        if accuracy not in self._option_sets:
            entry = BACKENDS.get(self.bare_name) or backend(self.name)
            curved = not cone(self.template.cone).polyhedral
            self._option_sets[accuracy] = entry.attempts(accuracy, curved)
        return self._option_sets[accuracy]

    def reply(self, natural: NaturalStep, accuracy: float) -> Reply:
        """The reply by each set of options in turn until one solves the step; else the last one."""
        if not natural.step.m:
            programs = natural.programs
            x = programs.joined([form.free() for form in programs.forms])
            return Reply(x, np.zeros(0), True, FREE, accuracy=accuracy)
        if self.unsafe and not natural.row_ratio <= ALIKE:
            status = f"not called: its rows differ by {natural.row_ratio:.0e} in natural units"
            return Reply(None, None, False, status, accuracy=accuracy)
        try:
            out_of_reach = self.write(natural)
        except InputError:
            raise
        except ValueError as error:  # of CVXPY's own checks, which may overflow
            status = one_line(f"not called: {error}")
            return Reply(None, None, False, status, accuracy=accuracy, cause=error)
        last: Reply | None = None
        none = Reply(None, None, False, "an answer that is not finite", accuracy=accuracy)
        for tried, options in self.option_sets(accuracy):
            status, cause = "an answer that is not finite", None
            try:
                reply = self.reply_with(options, natural)
            except Exception as error:  # whatever another package raises
                status, cause = f"the solver failed: {error}", error
            else:
                if reply.x is None or reply.lam is None:
                    without = f"{self.name} gives no multipliers through {self.interface}"
                    status = without if reply.solved else reply.status
                elif all_finite(reply.x) and all_finite(reply.lam):
                    if out_of_reach is not None:
                        # Residuals are those of the true gap.
                        reply.lam[out_of_reach] = 0.0
                    reply.accuracy = tried
                    last = reply
                    if reply.solved:
                        reply.status = "optimal"
                        return reply
            none = Reply(None, None, False, status, accuracy=tried, cause=cause)
        reply = none if last is None else last
        reply.status = one_line(reply.status)
        return reply


class NoSolver(Solver):
    """No backend: it is asked of no step.

    Parameters
    ----------
    template : StepData
        Any step.
    name : str
        ``"none"``.
    """

    interface = "none"
    fixed = ()

    def reply(self, natural: NaturalStep, accuracy: float) -> Reply:
        """A reply without numbers."""
        return Reply(None, None, False, "not called", accuracy=accuracy, asked=False)
