"""A solver of steps: one object that holds a compiled problem, and says what it is.

It knows its backend (``name``), by which interface it calls that (``interface``), and the kind of
step that its problem was compiled for (:meth:`Solver.fits`). Each interface is one class in a file
of its own, and :func:`~quasistatic_ref.solve.choice.solver_for` chooses among them.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum, step_optimum
from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.solution import SolverStatistics
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, Mask, finite
from quasistatic_ref.solve.backends import (
    BACKENDS,
    QPSOLVERS,
    UNSAFE,
    Options,
    backend,
)
from quasistatic_ref.solve.greeting import greeting_silenced
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import StepInBothUnits
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, differences

ALIKE: Final = 1e3
"""Largest ratio of the lengths of a step's rows, in natural units [-], at which a solver is called
that may not return. On rows of very different lengths quadprog 0.1.14 may loop without end, and
HiGHS 1.16 may end the process; the steps of the scenarios in models/ stay below 3."""

RELAXED = (1.0, 1e2, 1e4)
"""Accuracies tried where a backend is given second-order cones, relative to the one of the call.

Second-order cones cost Clarabel digits: of 40 planted steps it solves none at 1e-12, 39 at 1e-10
and all at 1e-9; of 40 grasp steps 37 at 1e-12 and all at 1e-11."""


FREE = "not called: the step has no rows"
"""Status of a step that is H delta_q = g."""


@dataclass(eq=False)
class NaturalAnswer:
    """A solver's answer, of finite numbers.

    Parameters
    ----------
    natural_delta_q : ndarray, shape (n_v,)
        In natural units [-].
    natural_lam : ndarray, shape (m,)
        In natural units [-], contact-major, the user's own rows last.
    statistics : SolverStatistics
    claimed : bool
        Whether the solver calls it a full solution.
    """

    natural_delta_q: Array
    natural_lam: Array
    statistics: SolverStatistics
    claimed: bool = True


@dataclass(eq=False)
class OptionSet:
    """A set of options, and what a solver keeps for it.

    Parameters
    ----------
    accuracy : float
        In natural units [-].
    options : dict
        The backend's own.
    kept : object
        The solver's.
    """

    accuracy: float
    options: Options
    kept: object = None


class Solver(ABC):
    """What solves steps of one kind.

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
    unsafe : bool
        Whether its backend may not return from steps whose rows are unlike each other.
    """

    interface: ClassVar[str]
    fixed: ClassVar[tuple[str, ...]]
    remembers: ClassVar[bool] = False

    def __init__(self, template: StepData, name: str) -> None:
        self.template = template
        self.name = name
        self.unsafe = name.removeprefix(QPSOLVERS) in UNSAFE
        if name.removeprefix(QPSOLVERS) == "highs":
            greeting_silenced()
        self._option_sets: dict[float, list[OptionSet]] = {}

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.template, self.name)

    def fits(self, step: StepData) -> bool:
        """Whether a step is of the kind that the problem was compiled for."""
        return not self.differences(step)

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
            raise InputError(problem, field="solver", value=f"{self.name}, {self.interface}")

    def differences(self, step: StepData) -> list[str]:
        """In what of ``fixed`` a step is not like the one that the problem was compiled for."""
        return differences(self.template, step, self.fixed)

    def in_both_units(self, step: StepData) -> StepInBothUnits:
        """The step in SI units and in natural units."""
        return StepInBothUnits(step)

    @abstractmethod
    def answer(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """The backend's answer to a step, in natural units; rows out of reach bear no load.

        Parameters
        ----------
        both : StepInBothUnits
            Of :meth:`in_both_units`.
        accuracy : float
            In natural units [-].

        Raises
        ------
        StepNotSolved
            If it gives none, or one whose numbers are not finite; or if it may not return and the
            rows of the step are unlike each other.
        """

    def full_answer(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """The same, if the backend calls it a full solution; StepNotSolved of anything less."""
        answer = self.answer(both, accuracy)
        if not answer.claimed:
            statistics = answer.statistics
            raise StepNotSolved(self.name, statistics.status, both.si_step, statistics.accuracy)
        return answer

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum, sought from the rows that an answer shows to be active, or from cold.

        It does not depend on where it is sought from.

        Raises
        ------
        StepInfeasible, StepIllPosed
        """
        warm = []
        if answer is not None:
            form = both.natural_form
            warm = warm_rows(form.A, answer.natural_lam, form.A @ answer.natural_delta_q - form.b)
        return step_optimum(both.si_step, warm)


class BackendSolver(Solver):
    """A solver that writes steps into a problem of a backend, and reads its replies."""

    @abstractmethod
    def write(self, both: StepInBothUnits) -> Mask | None:
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
    def reply(self, option_set: OptionSet, both: StepInBothUnits) -> Reply:
        """What the backend says to the problem as it is written."""

    def option_sets(self, accuracy: float) -> list[OptionSet]:
        """The sets of options for an accuracy in natural units [-], in the order to be tried."""
        if accuracy not in self._option_sets:
            entry = BACKENDS.get(self.name.removeprefix(QPSOLVERS)) or backend(self.name)
            least = max(accuracy, entry.floor)
            factors = (1.0,) if cone(self.template.cone).polyhedral else RELAXED
            self._option_sets[accuracy] = [
                OptionSet(k * least, options)
                for k in factors
                for options in entry.option_sets(k * least)
            ]
        return self._option_sets[accuracy]

    def answer(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """The answer, by each set of options in turn until one solves the step; else the last one.

        Raises
        ------
        StepNotSolved
            If there is none; or, before any call, if the backend may not return from such rows.
        """
        if not both.si_form.b.size:
            return self.free(both, accuracy)
        if self.unsafe and not both.row_ratio <= ALIKE:
            status = f"not called: its rows differ by {both.row_ratio:.0e} in natural units"
            raise StepNotSolved(self.name, status, both.si_step, accuracy)
        try:
            out_of_reach = self.write(both)
        except InputError:
            raise
        except ValueError as error:  # of CVXPY's own checks, which may overflow
            status = f"not called: {error}"
            raise StepNotSolved(self.name, status, both.si_step, accuracy) from error
        cause: Exception | None = None
        answer: NaturalAnswer | None = None
        for option_set in self.option_sets(accuracy):
            tried = option_set.accuracy
            status = "an answer that is not finite"
            try:
                reply = self.reply(option_set, both)
            except Exception as error:  # whatever another package raises
                status = f"the solver failed: {error}"
                cause = error
                continue
            cause = None
            if reply.x is None or reply.lam is None:
                status = "an answer without multipliers" if reply.solved else reply.status
            elif finite(reply.x) and finite(reply.lam):
                if out_of_reach is not None:
                    # Residuals are those of the true gap.
                    reply.lam[out_of_reach] = 0.0
                statistics = SolverStatistics(
                    self.name,
                    "optimal" if reply.solved else reply.status,
                    reply.iterations,
                    reply.seconds,
                    tried,
                    interface=self.interface,
                )
                answer = NaturalAnswer(reply.x, reply.lam, statistics, reply.solved)
                if reply.solved:
                    return answer
        if answer is not None:
            return answer
        raise StepNotSolved(self.name, status, both.si_step, tried) from cause

    def free(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """The answer to a step without rows, H delta_q = g: no backend is asked."""
        form = both.natural_form
        statistics = SolverStatistics(self.name, FREE, None, None, accuracy, None, self.interface)
        delta_q: Array = np.linalg.solve(form.H, form.g).astype(np.float64)
        return NaturalAnswer(delta_q, np.zeros(0), statistics)


class NoSolver(Solver):
    """No backend: the exact method starts from the working set of the step before, if any.

    Parameters
    ----------
    template : StepData
        Any step.
    name : str
        ``"none"``.
    """

    interface = "none"
    fixed = ()
    remembers = True

    def __init__(self, template: StepData, name: str) -> None:
        super().__init__(template, name)
        self._working_set: tuple[int, ...] = ()

    def answer(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """No answer: StepNotSolved."""
        raise StepNotSolved(self.name, "not called", both.si_step, accuracy)

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum, sought from the working set of the step before; errors of the base."""
        optimum = step_optimum(both.si_step, self._working_set)
        self._working_set = optimum.working_set
        return optimum
