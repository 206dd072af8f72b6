"""Large steps: the sparse standard form handed to a backend's sparse interface.

As :mod:`~quasistatic_ref.solve.native`, in time and memory that grow with the entries that are
there. Nothing here is certified exactly: residuals are what can be computed at this size.
"""

from __future__ import annotations

import math
from dataclasses import asdict

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from quasistatic_ref.certify.optimality import Residuals
from quasistatic_ref.errors import BackendError, StepNotSolved
from quasistatic_ref.solve.adapters.large import Clarabel, Osqp, Piqp, whole
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.solve.backends import BACKENDS, Options
from quasistatic_ref.solve.scaled import out_of_range
from quasistatic_ref.solve.units import Units, coordinate_units, from_natural, units_from
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.sparse_form import Pattern, SparseForm, sparse_form
from quasistatic_ref.tolerances import FAR, RESIDUAL_LIMIT

Adapter = Clarabel | Osqp | Piqp
ADAPTERS: dict[str, type[Adapter]] = {"clarabel": Clarabel, "osqp": Osqp, "piqp": Piqp}
"""Backends with a sparse interface."""


GAPS = ("tol_gap_abs", "tol_gap_rel", "eps_duality_gap_abs", "eps_duality_gap_rel")
"""Options that ask for a duality gap: Clarabel's, then PIQP's."""


def reachable(options: Options, rows: int) -> Options:
    """The same options, with a duality gap that rounding does not hide.

    The gap is a difference of sums over all rows, of terms near one in natural units: rounding
    leaves some 2^-52 of each. Asked for less, Clarabel takes 20 to 30 more steps in search of a
    lucky one, and PIQP all that it may.
    """
    least = rows * float(np.finfo(np.float64).eps)
    return options | {name: max(options[name], least) for name in GAPS if name in options}


class SparseProblem:
    """The pattern and the solvers of large steps of one kind, kept between them.

    Parameters
    ----------
    like : StepData
        With contacts in blocks, and no rows of the user's own.
    backend : str
        A name of :data:`ADAPTERS`.

    Raises
    ------
    BackendError
        If the backend takes no sparse matrices.
    """

    def __init__(self, like: StepData, backend: str) -> None:
        if backend not in ADAPTERS:
            problem = f"takes no sparse matrices; a step this large needs {', '.join(ADAPTERS)}"
            raise BackendError(problem, field="backend", value=backend)
        self.backend, self.pattern = backend, Pattern(like)
        P = self.pattern.P
        self.coordinate = coordinate_units(P.diagonal())
        S = self.coordinate
        self.P = csc_matrix(
            (P.data * S[P.indices] * S[self.pattern.P_column], P.indices, P.indptr), P.shape
        )
        self.H = whole(self.P)
        self.factor = splu(self.H)
        self.solvers: dict[tuple[float, int], Adapter] = {}

    def fits(self, step: StepData) -> bool:
        """Whether the step is of the kind that this was built for."""
        return self.pattern.fits(step)

    def solution(self, step: StepData, accuracy: float, certify: str) -> StepSolution:
        """The backend's answer, with residuals if ``certify`` is ``"residual"``.

        Raises
        ------
        StepNotSolved
            If the backend claims anything but a full solution, or its residuals are not small.
        StepDataError
            If products of the step's numbers leave the range of float64.
        """
        with np.errstate(all="ignore"):  # what overflows shows in the result
            natural, units = self._natural(step)
            reply, accuracy = self._reply(step, natural, accuracy)
            certificate = Certificate("none")
            if certify == "residual":
                certificate = self._judged(step, natural, reply, accuracy)
            delta_q, lam = from_natural(reply.x, reply.lam, units)
        if not math.isfinite(delta_q.sum() + lam.sum()):
            raise out_of_range(step)
        statistics = SolverStatistics(
            self.backend, "optimal", reply.iterations, reply.seconds, accuracy
        )
        return StepSolution(
            delta_q=delta_q,
            lam=lam,
            lam_extra=np.zeros(0),
            wrench=contact_wrenches(step.contacts, lam, step.h, step.cone),
            backend=self.backend,
            certificate=certificate,
            statistics=statistics,
            cone=step.cone,
        )

    def _natural(self, step: StepData) -> tuple[SparseForm, Units]:
        """The program in natural units, and the units."""
        form, S = sparse_form(step, self.pattern), self.coordinate
        rows = form.A.data * S[self.pattern.column]
        squares = np.bincount(form.A.indices, rows * rows, minlength=len(form.b))
        y = form.g * S
        energy = math.sqrt(max(float(y @ self.factor.solve(y)), 0.0))  # ||H^-1 g||_H
        units = units_from(S, np.sort(squares), energy, form.b)
        if not (0 < units.length < math.inf and 0 < units.size < math.inf):
            raise out_of_range(step)
        A = csc_matrix((rows / units.length, form.A.indices, form.A.indptr), form.A.shape)
        g, b = y / units.size, form.b / (units.size * units.length)
        return SparseForm(self.P, g, A, b), units

    def _reply(self, step: StepData, natural: SparseForm, accuracy: float) -> tuple[Reply, float]:
        """What the backend says; contacts out of reach are handed over nearer than they are."""
        reach = -FAR * np.maximum(1.0, np.sqrt(_row_squares(natural)))
        near = SparseForm(natural.P, natural.g, natural.A, np.maximum(natural.b, reach))
        entry = BACKENDS[self.backend]
        accuracy = max(accuracy, entry.floor)
        status = ""
        for i, options in enumerate(entry.attempts(accuracy)):
            solver = self._solver(near, reachable(options, len(near.b)), accuracy, i)
            reply = solver.reply(near)
            if reply.solved and math.isfinite(reply.x.sum() + reply.lam.sum()):
                reply.lam[natural.b < reach] = 0.0  # the judge, who sees the true gap, decides
                return reply, accuracy
            status = reply.status
        raise StepNotSolved(self.backend, status, step, accuracy)

    def _solver(self, form: SparseForm, options: Options, accuracy: float, i: int) -> Adapter:
        key = (accuracy, i)
        if key not in self.solvers:
            self.solvers[key] = ADAPTERS[self.backend](form, options)
        return self.solvers[key]

    def _judged(
        self, step: StepData, form: SparseForm, reply: Reply, accuracy: float
    ) -> Certificate:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12`, natural units; at this size no error bound."""
        x, lam = reply.x, reply.lam
        balance, slack = self.H @ x - form.g - form.A.T @ lam, form.A @ x - form.b
        residuals = Residuals(
            stationarity=float(np.abs(balance).max(initial=0.0)),  # Eq. (9), mended
            primal=float(np.maximum(-slack, 0.0).max(initial=0.0)),  # Eq. (10)
            dual=float(np.maximum(-lam, 0.0).max(initial=0.0)),  # Eq. (11)
            complementarity=float(np.abs(slack * lam).max(initial=0.0)),  # Eq. (12)
        )
        if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
            status = f"it said optimal, but its worst residual is {residuals.worst:.1e}"
            raise StepNotSolved(self.backend, status, step, accuracy, residuals)
        return Certificate("residual", asdict(residuals))


def _row_squares(form: SparseForm) -> Array:
    """Squared lengths of the rows."""
    squares = np.bincount(form.A.indices, form.A.data**2, minlength=len(form.b))
    return squares.astype(np.float64)
