r"""A step under Coulomb's law, as a fixed point of steps of the convex model.

The convex model's contacts rise while they slide, so that gap >= |slip| in the norm of their cone.
With phi + s in the place of phi, where s is that norm of the slip, they do not: the optimum
satisfies Signorini's conditions and Coulomb's law with the cone's friction. This is De Saxce's
correction; Acary, Cadoux, Lemarechal and Malick (2011) find s by iteration.

Here the iterates are extrapolated (Anderson 1965). The map from s to the slip's norm is piecewise
linear in a polyhedral cone, so that extrapolation ends at the fixed point once its iterates are on
the same piece; the iteration alone converges at the rate mu^2 / (1 + mu^2) for a block. The proof
is the exact optimum with phi + s, whose own s that is. Coulomb's law may have no solution, or
several: a fixed point is one of them, and where the iteration reaches none, nothing is claimed.

In a polyhedral cone there is a solution if the convex step has one. For each contact, with p_n,
beta, sigma >= 0, the law is the complementarity problem (Anitescu and Potra 1997)

.. math:: 0 \le p_n \perp \phi + J_n\,\delta q \ge 0,\quad
          0 \le \beta_i \perp \sigma + D_i\,\delta q \ge 0,\quad
          0 \le \sigma \perp p_n - \textstyle\sum_i\beta_i \ge 0.

Its matrix M is copositive: z'M z = ||J_n'p_n + D'beta||^2 in the norm of H^-1, plus sigma'p_n. It
has a solution if z >= 0, M z >= 0 and z'M z = 0 imply q'z >= 0 for its constant q (Cottle, Pang and
Stone, Theorem 3.8.6). Here they imply J_n'p_n + D'beta = 0 and p_n >= sum beta, and q'z = phi'p_n.
If this were negative, beta, with what is missing to p_n spread evenly over the rows, would be a
Farkas vector of the convex step.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.residuals import largest
from quasistatic_ref.errors import InputError, check_kind, keywords_named
from quasistatic_ref.numbers.arrays import (
    Array,
    all_finite,
    checked_numbers,
    positive_number,
    read_only,
    without_warnings,
)
from quasistatic_ref.optional.fixed_point import Iterate, fixed_point
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.solve.backends import Certify, check_certify
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solve import step_solution
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.solution import (
    Certificate,  # noqa: F401 get_type_hints looks here for types of inherited fields
    SolverStatistics,  # noqa: F401 as Certificate
    StepSolution,
)
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.text.plain import field_values
from quasistatic_ref.tolerances import ACCURACY

COULOMB_RESIDUAL: Final = 1e-12
"""Largest difference of s from that of the next iterate, relative to the longest motion of a
contact [-], at which s is its own: each iterate is exact, and s a sum of rounded products."""

MOST_STEPS = 200
"""Iterates after which no fixed point is expected."""


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


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CoulombSolution(StepSolution):
    """The result of the iteration of ``coulomb_step``: its last step, and whether it converged.

    ``coulomb_step`` makes it; its constructor checks nothing.

    It is its last iterate, the exact optimum of the step with phi + s, which is its `step` and that
    of its certificate.

    Parameters
    ----------
    converged : bool
        Whether s is its own, to within 1e-12 of the longest motion of a contact. If not, nothing is
        claimed of the step under Coulomb's law: neither that it has a solution nor that it has
        none.
    s : ndarray, shape (n_c,)
        By how much phi was raised [m].
    s_residual : float
        Largest difference of s from that of the solution's own slip [m]. The certificate
        proves all other conditions of the complementarity problem, for phi + s in float64.
    s_iterations : int
        Number of convex steps that were solved.
    posed : StepData
        The step as it was given, with phi.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.coulomb_step(step).converged
    True
    """

    converged: bool
    s: Array
    s_residual: float
    s_iterations: int
    posed: StepData


@keywords_named
def coulomb_step(
    step: StepData,
    backend: str | Solver | None = None,
    *,
    accuracy: float = ACCURACY,
    start: ArrayLike | None = None,
    most: int = MOST_STEPS,
) -> CoulombSolution:
    """The step under Coulomb's law with the friction of the step's cone.

    Parameters
    ----------
    step : StepData
        SI units.
    backend, accuracy
        As of :func:`~quasistatic_ref.solve.solve.solve_step`; each iterate is certified.
    start : array_like, shape (n_c,), optional
        The first s [m], >= 0; by default 0, with which the first iterate is the convex step. There
        may be several solutions, and which of them is found depends on it.
    most : int
        Iterates after which no fixed point is expected.

    Returns
    -------
    CoulombSolution

    Raises
    ------
    InputError
        If `start`, `most` or `accuracy` is not as above.
    QuasistaticError
        Those of ``solve_step``, of any iterate. StepInfeasible is said of the convex step: in
        penetration it may have no solution where the step under Coulomb's law has one, which a
        larger `start` may reach.

    Examples
    --------
    >>> step = qr.load_scenario("block_push", steps=1).run(progress=False).step_data(0)
    >>> qr.coulomb_step(step).converged
    True
    """
    check_step(step)
    contacts = step.contacts
    s = np.zeros(contacts.n_c) if start is None else checked_numbers(start, "start", InputError)
    check_kind(most, int, "most", "a whole number")
    accuracy = positive_number(accuracy, "accuracy")
    if s.shape != (contacts.n_c,) or not (all_finite(s) and s.min(initial=0.0) >= 0):
        raise InputError("must have one length >= 0 for each contact", field="start", value=start)
    if most < 1:
        raise InputError("must be at least 1", field="most", value=most)
    solver = backend if isinstance(backend, Solver) else solver_for(step, backend)
    return fixed_point_from(step, s, solver, accuracy, most=most)


def fixed_point_from(
    step: StepData,
    s: Array,
    solver: Solver,
    accuracy: float,
    certify: Certify = "full",
    within: float = COULOMB_RESIDUAL,
    least: float = 0.0,
    most: int = MOST_STEPS,
) -> CoulombSolution:
    """The iteration from s; what :func:`coulomb_step` returns.

    Parameters
    ----------
    step, s, solver, accuracy, most
        As of :func:`coulomb_step`: s of shape (n_c,) [m], accuracy in natural units [-].
    certify : str
        ``"off"``: an iterate that the backend solves is not proved.
    within : float
        Difference of s from that of the next iterate, over the longest motion of a contact [-], at
        which s is its own.
    least : float
        Motion that counts as the longest where all are shorter [m].
    """
    raised = RaisedSteps(step, solver, accuracy, certify, within, least)
    end, count = fixed_point(raised.at, s, most)
    return CoulombSolution(
        **field_values(end.of),
        converged=end.converged,
        s=read_only(end.s),
        s_residual=end.residual,
        s_iterations=count,
        posed=step,
    )


class RaisedSteps:
    """The convex steps with phi + s of a step: what does not change with s is formed once.

    Parameters
    ----------
    step, solver, accuracy, certify, within, least
        As of :func:`fixed_point_from`: within [-], least [m].

    Raises
    ------
    InputError
        If the solver does not fit the step.
    """

    def __init__(
        self,
        step: StepData,
        solver: Solver,
        accuracy: float,
        certify: Certify,
        within: float,
        least: float,
    ) -> None:
        solver.check(step)
        check_certify(solver.name, certify)
        self._solver = solver
        self._accuracy = accuracy
        self._certify = certify
        self._within = within
        self._least = least
        self._first = NaturalStep(step.replace())  # whole matrices, as a step that is handed in
        contacts = step.contacts
        _, *self._slips = frame_jacobian(contacts, contacts.J)
        self._moves = np.abs(contacts.J)

    def at(self, s: Array) -> Iterate[StepSolution]:
        """The convex step with phi + s, shape (n_c,) [m], and the norm of its slips."""
        step = self._first.step
        solution = self._solution(step.with_fields(contacts=step.contacts.raised(s)))
        slips = np.column_stack([J @ solution.delta_q for J in self._slips])
        slip = slip_norm(step.contacts.mu * slips, step.cone)
        residual = largest(np.abs(slip - s))
        longest = max(self._least, largest(self._longest_slips(solution.delta_q)))
        return Iterate(s, slip, residual, residual <= self._within * longest, solution)

    def _solution(self, raised: StepData) -> StepSolution:
        """The convex step; proved, too, where a backend alone has no answer."""
        solve = partial(without_warnings, step_solution, self._first.with_gaps(raised))
        try:
            return solve(self._solver, self._accuracy, self._certify)
        except StepNotSolved as failure:
            if self._certify == "full" or type(failure) is not StepNotSolved:
                raise
            return solve(self._solver, self._accuracy, "full")

    def _longest_slips(self, delta_q: Array) -> Array:
        """Sums of sizes of the terms of slips, shape (n_c,) [m]: rounding is relative to them."""
        moves = self._moves @ np.abs(delta_q)
        mu_v, _, mu_omega = self._first.step.contacts.mu.T
        return np.asarray(mu_v * moves[:, :3].sum(axis=1) + mu_omega * moves[:, 3])


def simulated_solution(step: StepData, solver: Solver, accuracy: float) -> CoulombSolution:
    """The step of a simulator under Coulomb's law, from s = 0.

    Parameters
    ----------
    step : StepData
        SI units.
    solver, accuracy
        As of :func:`coulomb_step`; the accuracy in natural units [-].

    Raises
    ------
    NoFixedPoint
        If no solution is found.
    """
    solution = coulomb_step(step, solver, accuracy=accuracy)
    if not solution.converged:
        raise NoFixedPoint(step, solution.s_iterations, solution.s_residual)
    return solution
