"""A step under many loads: programs that differ in g alone, and answers that are known already."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.optimum import ProofCache
from quasistatic_ref.numbers.arrays import Array, Indices, all_finite, read_only
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.parts import part
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.solver import BackendSolver, Reply, Solver
from quasistatic_ref.solve.units import ScaledStep, natural_size
from quasistatic_ref.step.data import StepData


class ManyAnswers(NamedTuple):
    """A backend's answers to N programs that differ in g alone, in natural units [-].

    Parameters
    ----------
    x, lam : ndarray, shapes (N, n_v) and (N, m)
    status : list of str, length N
        ``"optimal"`` where it claims a solution.
    iterations : ndarray of int, shape (N,)
    """

    x: Array
    lam: Array
    status: list[str]
    iterations: Indices


OPTIMAL = "optimal"
ColdAnswers = Callable[[ScaledStep, Array, Array, Options], ManyAnswers]
"""A step, g (N, n_v) [N s, N m s] and sizes (N,) of others, options -> their answers, each cold."""


class ManyLoads:
    """N steps from one place, under other targets and loads.

    Parameters
    ----------
    first : StepData
        One of them, or another from there.
    change, tau : ndarray, shapes (N, n_a) and (N, n_v)
        delta_q_bar_a [m, rad]; all forces but the springs' [N, N m].
    """

    def __init__(self, first: StepData, change: Array, tau: Array) -> None:
        self.first = first
        self.change = read_only(change)
        self.tau = read_only(tau + 0.0)

    def __len__(self) -> int:
        return len(self.tau)

    def step(self, k: int) -> StepData:
        """Step k."""
        n_a = self.first.n_a
        tau = self.tau[k]
        loads = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": self.change[k]}
        step: StepData = self.first.with_fields(**loads)
        return step

    @property
    def linear_terms(self) -> Array:
        """The linear terms g of Eq. :eq:`eq-13`, shape (N, n_v) [N s, N m s]."""
        first = self.first
        g = self.tau.copy()
        if first.n_a:
            g[:, : first.n_a] += product(self.change, first.K_q.T)  # Eq. (1)
        return np.asarray(first.h * g)


class KnownAnswers:
    """The answers of DAQP to N steps, as those of a solver.

    Parameters
    ----------
    many : ManyLoads
    scaled : ScaledStep
        Of its first step.
    solver : Solver
        DAQP's.
    accuracy : float
        In natural units [-].

    Attributes
    ----------
    delta_q, lam : ndarray, shapes (N, n_v) and (N, m)
        The answers [m, rad], [N s].
    failed : list of int
        Those that are none.
    """

    def __init__(
        self, many: ManyLoads, scaled: ScaledStep, solver: Solver, accuracy: float
    ) -> None:
        assert isinstance(solver, BackendSolver)
        cold_answers: ColdAnswers = part("cold_answers")
        g = many.linear_terms
        free = scaled.layout.natural_hessian_of(scaled.step).free_lengths(g)
        S, length, _ = scaled.units
        push_out = scaled.deepest / length
        sizes = np.array([natural_size(S, one, push_out) for one in free.tolist()])
        ((_, options),) = solver.option_sets(accuracy)
        self._answers = answers = cold_answers(scaled, g, sizes, options)
        self._sizes = sizes
        self._scaled = scaled
        self._solver = solver
        self._proofs = ProofCache()
        self.delta_q = answers.x * (sizes[:, None] * S)
        self.lam = answers.lam * (sizes / length)[:, None]
        finite = np.isfinite(np.hstack([self.delta_q, self.lam])).all(axis=1)
        right = finite & (np.array(answers.status, dtype=np.str_) == OPTIMAL)
        self.failed = np.flatnonzero(~right).tolist()

    def scaled(self, k: int, step: StepData) -> ScaledStep:
        """Step k with its program."""
        scaled = self._scaled.under(step)
        if np.isfinite(self._sizes[k]):  # else it is refused
            scaled.units = self._scaled.units._replace(size=float(self._sizes[k]))
        return scaled

    def solver(self, k: int) -> Solver:
        """A solver that answers step k."""
        x, lam, status, iterations = self._answers
        optimal = status[k] == OPTIMAL
        reply = Reply(x[k], lam[k], optimal, status[k], int(iterations[k]))
        return Answered(self._solver, reply, self._proofs)


class Answered(Solver):
    """A solver whose answer to a step is known: that of another solver.

    Parameters
    ----------
    solver : Solver
    reply : Reply
        Its answer to the step.
    proofs : ProofCache
        Those of the last step.
    """

    fixed = ()

    def __init__(self, solver: Solver, reply: Reply, proofs: ProofCache) -> None:
        super().__init__(solver.template, solver.name)
        self.__dict__.update(interface=solver.interface, gives_basic_rows=solver.gives_basic_rows)
        self.reply = reply
        self.proofs = proofs

    def answer(self, scaled: ScaledStep, accuracy: float) -> Reply:
        """The known answer; StepNotSolved if its numbers are not finite."""
        reply = self.reply
        reply.accuracy = accuracy
        if not all(map(all_finite, reply.answer)):
            raise StepNotSolved(self.name, "an answer that is not finite", scaled.step, accuracy)
        return reply
