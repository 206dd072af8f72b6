"""A step under Coulomb's law, as a fixed point of steps of the convex model.

The convex model's contacts rise while they slide, so that gap >= |slip| in the norm of their cone.
With phi + s in the place of phi, where s is that norm of the slip, they do not: the optimum
satisfies Signorini's conditions and Coulomb's law with the cone's friction. This is De Saxce's
correction; Acary, Cadoux, Lemarechal and Malick (2011) find s by iteration, as is done here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.residuals import largest
from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import InputError, NoFixedPoint
from quasistatic_ref.formats.plain import field_values
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver, solver_for
from quasistatic_ref.step.arrays import Array, finite, read_only
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.tolerances import ACCURACY, COULOMB_RESIDUAL

MOST = 200
"""Iterates after which no solution is claimed."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CoulombSolution(StepSolution):
    """What the iteration of :func:`coulomb_step` ended at.

    It is its last iterate, the exact optimum of the step with phi + s, which is its `step` and that
    of its certificate.

    Parameters
    ----------
    found : bool
        Whether s is its own, to within 1e-12 of the longest motion of a contact. If not, nothing is
        claimed of the step under Coulomb's law.
    s : ndarray, shape (n_c,)
        By how much phi was raised [m].
    s_residual : float
        Largest difference of s from that of the solution's own slip [m]. The certificate
        proves all other conditions of the complementarity problem, for phi + s in float64.
    s_iterations : int
        Number of convex steps that were solved.
    """

    found: bool
    s: Array
    s_residual: float
    s_iterations: int


def coulomb_step(
    step: StepData,
    solver: str | Solver | None = None,
    *,
    fast: bool = False,
    accuracy: float = ACCURACY,
    start: ArrayLike | None = None,
    most: int = MOST,
) -> CoulombSolution:
    """The step under Coulomb's law with the friction of the step's cone.

    Parameters
    ----------
    step : StepData
        SI units.
    solver, fast, accuracy
        As of :func:`~quasistatic_ref.solve.solve.solve_step`; each iterate is certified.
    start : array_like, shape (n_c,), optional
        The first s [m], >= 0; by default 0, with which the first iterate is the convex step. There
        may be several solutions, and which of them is found depends on it.
    most : int
        Iterates after which no solution is claimed.

    Returns
    -------
    CoulombSolution

    Raises
    ------
    InputError
        If `start` or `most` is not as above.
    QuasistaticError
        Those of ``solve_step``, of any iterate.

    Examples
    --------
    >>> step = qr.load_scenario("block_push", steps=1).run(progress=False).step_data(0)
    >>> qr.coulomb_step(step).found
    True
    """
    contacts = step.contacts
    own = np.zeros(contacts.n_c) if start is None else np.array(start, dtype=np.float64)
    if own.shape != (contacts.n_c,) or not (finite(own) and own.min(initial=0.0) >= 0):
        raise InputError("must have one length >= 0 for each contact", field="start", value=start)
    if most < 1:
        raise InputError("must be at least 1", field="most", value=most)
    if not isinstance(solver, Solver):
        solver = solver_for(step, solver, fast)
    iterations = 0
    found = False
    while not found and iterations < most:
        iterations += 1
        s = own
        raised = step.replace(contacts=contacts.raised(s))
        solution = solve_step(raised, solver, accuracy=accuracy)
        own = slip_norms(step, solution.delta_q)
        residual = largest(np.abs(own - s))
        found = residual <= COULOMB_RESIDUAL * largest(longest_slips(step, solution.delta_q))
    return CoulombSolution(
        **field_values(solution),
        found=found,
        s=read_only(s),
        s_residual=residual,
        s_iterations=iterations,
    )


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
    if not solution.found:
        raise NoFixedPoint(step, solution.s_iterations, solution.s_residual)
    return solution


def slip_norms(step: StepData, delta_q: Array) -> Array:
    """The norm s of each contact's slip, shape (n_c,) [m]: the least gap that its cone asks for."""
    _, *slips = (J @ delta_q for J in frame_jacobian(step.contacts, step.contacts.J))
    scaled = step.contacts.mu * np.column_stack(slips)
    kind = cone(step.cone)
    if not kind.polyhedral:
        return np.asarray(np.linalg.norm(scaled, axis=1))
    # The largest of the rows without the gap: of the pyramid, |mu_v slip_1|, ..., |mu_omega spin|.
    return np.asarray((scaled @ kind.matrix[:, 1:].T).max(axis=1, initial=0.0))


def longest_slips(step: StepData, delta_q: Array) -> Array:
    """Sums of the sizes of the terms of slips, shape (n_c,) [m]: rounding is relative to them."""
    moves = np.abs(step.contacts.J) @ np.abs(delta_q)
    mu_v, _, mu_omega = step.contacts.mu.T
    return np.asarray(mu_v * moves[:, :3].sum(axis=1) + mu_omega * moves[:, 3])
