"""Some steps of a run, and the arrays of a record that are formed of all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.step.contacts import Contacts, spread, stacked
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.standard_form import contact_inequalities, linear_terms

if TYPE_CHECKING:
    from quasistatic_ref.simulate.result import StepResult


class Block:
    """The numbers of K consecutive steps, in the form in which a trajectory stores them.

    Parameters
    ----------
    results : sequence of StepResult
        K, of one simulator.
    n_v : int
        Number of coordinates without private ones.
    """

    def __init__(self, results: Sequence[StepResult], n_v: int) -> None:
        self.results = results
        self.n_v = n_v
        self.first = results[0].step

    def of_each(self, name: str) -> NDArray[Any]:
        """An attribute of the results, such as ``points.phi``, shape (K, ...) [its unit]."""
        value = attrgetter(name)
        return np.array([value(result) for result in self.results])

    @cached_property
    def contacts(self) -> Contacts:
        """The contacts of all steps, one step after another."""
        return stacked([result.step.contacts for result in self.results])

    def _by_step(self, array: NDArray[Any]) -> NDArray[Any]:
        """Numbers of all contacts, (K n_c, ...), by steps: (K, n_c, ...) [any unit]."""
        K = len(self.results)
        return array.reshape(K, len(array) // K, *array.shape[1:])

    @cached_property
    def delta_q(self) -> Array:
        """The displacements delta_q, shape (K, n_v) [m, rad]."""
        return np.array([result.solution.delta_q[: self.n_v] for result in self.results])

    @cached_property
    def loads(self) -> tuple[Array, Array]:
        """tau_a and tau_u, shapes (K, n_a) and (K, N_u) [N, N m]."""
        return self.of_each("step.tau_a"), self.of_each("step.tau_u")

    @property
    def tau(self) -> Array:
        """All generalised forces except those of springs, shape (K, n_v) [N, N m]."""
        return np.hstack(self.loads)[:, : self.n_v]

    @cached_property
    def lam(self) -> Array:
        """Multipliers of the contacts, shape (K, m) [N s]."""
        m = self.first.offsets[-1]
        return np.array([result.solution.lam[:m] for result in self.results])

    @property
    def wrench(self) -> Array:
        """Contact wrenches that lam adds up to, (f_d1, f_d2, f_n, tau_n) [N, N m], (K, n_c, 4)."""
        first = self.first
        return without_warnings(contact_wrenches, first.contacts, self.lam, first.h, first.cone)

    @property
    def worst_residual(self) -> Array:
        """The largest residuals in natural units, (K,) [-]; NaN if nothing was certified."""
        each = (result.solution.certificate.residuals.values() for result in self.results)
        return np.array([max(residuals, default=np.nan) for residuals in each])

    @property
    def motion(self) -> Array:
        """J delta_q of the contacts, shape (K, n_c, 4) [m, m, m, rad], without private rises."""
        contacts = self.contacts
        entries = np.zeros((len(self.results), contacts.n_v + 1))
        entries[:, : self.n_v] = self.delta_q
        column = self._by_step(contacts.column)
        moved = np.take_along_axis(entries, column.reshape(len(column), -1), axis=1)
        if not moved.size:
            return np.zeros((*column.shape[:2], 4))
        by_column = moved.reshape(*contacts.column.shape, 1)
        return self._by_step(product(contacts.own, by_column)[..., 0] + 0.0)

    @cached_property
    def _inequalities(self) -> tuple[Array, Array]:
        contacts = self.contacts
        first = self.first
        K = len(self.results)
        own, b = contact_inequalities(contacts, first.cone, np.tile(first.mask, (K, 1)))
        column = np.repeat(contacts.column, np.tile(first.counts, K), axis=0)
        A = self._by_step(spread(own[:, None], column, first.n_v)[:, 0])
        b = self._by_step(b)
        if not first.extra.names:
            return A, b
        A = np.concatenate([A, self.of_each("step.extra.A")], axis=1)
        return A, np.concatenate([b, self.of_each("step.extra.b")], axis=1)

    @property
    def A(self) -> Array:
        """The A of the quadratic programs, shape (K, M, N)."""
        return self._inequalities[0]

    @property
    def b(self) -> Array:
        """The b of the quadratic programs, shape (K, M)."""
        return self._inequalities[1]

    @property
    def g(self) -> Array:
        """The g of the quadratic programs, shape (K, N)."""
        change = self.of_each("step.delta_q_bar_a")
        g = linear_terms(self.first.h, self.first.K_q, change, *self.loads)
        return g if self.first.extra.cost is None else g + self.of_each("step.extra.g")

    @property
    def J(self) -> Array:
        """Contact Jacobians, shape (K, n_c, 4, N) [m, m, m, rad]."""
        contacts = self.contacts
        return self._by_step(spread(contacts.own, contacts.column, contacts.n_v))

    @cached_property
    def _compliant(self) -> list[tuple[Array, float]]:
        """Forces of single contacts and their imbalance in each step; NaN if none are found."""
        unknown = np.full((self.first.contacts.n_c, 4), np.nan), np.nan
        every: list[tuple[Array, float]] = []
        for result in self.results:
            try:
                every.append((result.solution.compliant.wrench, result.solution.imbalance))
            except (StepNotSolved, ArithmeticError):  # the run goes on
                every.append(unknown)
        return every

    @property
    def forces(self) -> Array:
        """Forces of single contacts, shape (K, n_c, 4) [N, N m]; NaN if none are found."""
        return np.array([wrench for wrench, _ in self._compliant], np.float64)

    @property
    def imbalance(self) -> Array:
        """The share of the load that the forces do not balance, (K,) [-]; NaN if none are found."""
        return np.array([imbalance for _, imbalance in self._compliant], np.float64)
