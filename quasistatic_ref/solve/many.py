"""A step under many loads: programs that differ in g alone, and replies that are known already."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.optimum import ProofCache
from quasistatic_ref.numbers.arrays import Array, Indices, all_finite, read_only
from quasistatic_ref.parts import part
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import BackendSolver, Reply, Solver
from quasistatic_ref.solve.units import natural_size
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import spring_load


class ManyReplies(NamedTuple):
    """A backend's replies to N programs that differ in g alone, in natural units [-].

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
ColdReplies = Callable[[NaturalStep, Array, Array, Options], ManyReplies]
"""A step, g (N, n_v) [N s, N m s] and sizes (N,) of others, options -> its replies, each cold."""


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
            g[:, : first.n_a] += spring_load(first.K_q, self.change)  # Eq. (1)
        g *= first.h
        cost = first.extra.cost
        return g if cost is None else g + cost[1]

    def posed(self, first: StepData) -> ManyLoads:
        """These steps with what a user adds to the first one, whatever the loads: rows and costs.

        Private coordinates come last, each with its own load.
        """
        own = first.tau_u[self.first.n_u :]
        own_loads = np.broadcast_to(own, (len(self), len(own)))
        return ManyLoads(first, self.change, np.hstack([self.tau, own_loads]))


class PrecomputedReplies:
    """The replies of DAQP to N steps, as those of a solver.

    Parameters
    ----------
    many : ManyLoads
    natural : NaturalStep
        Of its first step.
    solver : Solver
        DAQP's.
    accuracy : float
        In natural units [-].

    Attributes
    ----------
    delta_q, lam : ndarray, shapes (N, n_v) and (N, m)
        The replies [m, rad], [N s].
    failed : list of int
        Those that are none.
    """

    def __init__(
        self, many: ManyLoads, natural: NaturalStep, solver: Solver, accuracy: float
    ) -> None:
        assert isinstance(solver, BackendSolver)
        cold_replies: ColdReplies = part("cold_replies")
        g = many.linear_terms
        free = natural.layout.natural_hessian_of(natural.step).free_lengths(g)
        S, length, _ = natural.units
        push_out = natural.deepest / length
        sizes = np.array([natural_size(S, one, push_out) for one in free.tolist()])
        ((_, options),) = solver.option_sets(accuracy)
        self._replies = replies = cold_replies(natural, g, sizes, options)
        self._sizes = sizes
        self._natural = natural
        self._solver = solver
        self._proofs = ProofCache()
        self.delta_q = replies.x * (sizes[:, None] * S)
        self.lam = replies.lam * (sizes / length)[:, None]
        finite = np.isfinite(np.hstack([self.delta_q, self.lam])).all(axis=1)
        right = finite & (np.array(replies.status, dtype=np.str_) == OPTIMAL)
        self.failed = np.flatnonzero(~right).tolist()

    def natural(self, k: int, step: StepData) -> NaturalStep:
        """Step k with its program."""
        natural = self._natural.with_loads(step)
        if np.isfinite(self._sizes[k]):  # else it is refused
            natural.units = self._natural.units._replace(size=float(self._sizes[k]))
        return natural

    def solver(self, k: int) -> Solver:
        """A solver that has the reply to step k."""
        x, lam, status, iterations = self._replies
        optimal = status[k] == OPTIMAL
        reply = Reply(x[k], lam[k], optimal, status[k], int(iterations[k]))
        return Precomputed(self._solver, reply, self._proofs)


class Precomputed(Solver):
    """A solver whose reply to a step is known: that of another solver.

    Parameters
    ----------
    solver : Solver
    reply : Reply
        Its reply to the step.
    proofs : ProofCache
        Those of the last step.
    """

    fixed = ()

    def __init__(self, solver: Solver, reply: Reply, proofs: ProofCache) -> None:
        super().__init__(solver.template, solver.name)
        self.__dict__.update(interface=solver.interface, gives_basic_rows=solver.gives_basic_rows)
        self.known = reply
        self.proofs = proofs

    def reply(self, natural: NaturalStep, accuracy: float) -> Reply:
        """The known reply, without numbers if these are not finite."""
        known = self.known
        known.accuracy = accuracy
        if all(map(all_finite, known.point)):
            return known
        return Reply(None, None, False, "an answer that is not finite", accuracy=accuracy)
