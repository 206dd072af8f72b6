"""The native engine: a step handed to a solver's own interface, without CVXPY.

What CVXPY would make of a step is its standard form (a test holds them equal); the matrices are
written into arrays that are kept, in natural units, and the solver is updated in place. Between
the steps of a simulator it starts from the answer before, where it can.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import BackendError, StepNotSolved, suggestion
from quasistatic_ref.solve.adapters.program import Adapter, Program, Reply
from quasistatic_ref.solve.answer import Answer
from quasistatic_ref.solve.backends import BACKENDS, NONE, QPSOLVERS, Options
from quasistatic_ref.solve.scaled import Scaled
from quasistatic_ref.solve.units import Metric, reach_of_rows
from quasistatic_ref.step.arrays import finite
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import SolverStatistics
from quasistatic_ref.tolerances import FAR

ADAPTERS = {"clarabel": "Clarabel", "daqp": "Daqp", "osqp": "Osqp", "piqp": "Piqp",
            "quadprog": "Quadprog"}  # fmt: skip
"""Backends with an interface of their own here: class of the module of that name in adapters/."""


@cache
def native_backends() -> tuple[str, ...]:
    """Names of the backends that the native engine reaches here."""
    return tuple(name for name in ADAPTERS if find_spec(name) is not None)


def check_native(name: str, cone_name: str) -> None:
    """Refuse a backend or a cone that the native engine cannot take.

    Raises
    ------
    BackendError
        In one sentence that says which it can.
    """
    if not cone(cone_name).polyhedral:
        problem = f"takes rows only; cone = {cone_name!r} needs engine = 'cvxpy'"
        raise BackendError(problem, field="engine", value="native")
    if name == NONE or name in native_backends():
        return
    there = ", ".join(native_backends())
    if name in ADAPTERS:
        problem = f"is not installed; pip install {BACKENDS[name].package or name}"
    elif name in BACKENDS or str(name).removeprefix(QPSOLVERS) in BACKENDS:
        problem = "has no native interface here; use engine = 'cvxpy'"
    else:
        problem = f"is not a backend{suggestion(str(name), native_backends())}"
    raise BackendError(f"{problem}; engine = 'native' reaches {there}", field="backend", value=name)


class NativeProblem:
    """The arrays and the solver of steps of one kind, kept between them.

    Parameters
    ----------
    like : StepData
        A step of the same kind, as for :class:`~quasistatic_ref.step.problem.StepProblem`.
    backend : str
        A name of :data:`ADAPTERS`.
    warm : bool
        Whether to start from the answer before, where the solver can.

    Raises
    ------
    BackendError
        If the backend has no native interface, or the cone is not polyhedral.
    """

    def __init__(self, like: StepData, backend: str, warm: bool = True) -> None:
        check_native(backend, like.cone)
        module = import_module(f"quasistatic_ref.solve.adapters.{backend}")
        self.adapter: type[Adapter] = getattr(module, ADAPTERS[backend])
        self.backend, self.warm, self.like = backend, warm and self.adapter.WARM, like
        n, m, order = like.n_v, int(like.offsets[-1]) + len(like.extra.names), self.adapter.ORDER
        self.program = Program(
            np.zeros((n, n), order=order), np.zeros(n), np.zeros((m, n), order=order), np.zeros(m)
        )
        self.rows = m
        self.attempts: dict[float, list[_Attempt]] = {}
        self.metric: Metric | None = None
        self.fitting: StepData | None = None

    def fits(self, step: StepData) -> bool:
        """Tell whether a step can be written into the same arrays."""
        if step is self.fitting:  # asked by a simulator, and again when it is solved
            return True
        like = self.like
        # A step that was moved from another shares its counts, and all shapes.
        fits = step.counts is like.counts or (
            (step.n_a, step.n_u) == (like.n_a, like.n_u)
            and step.cone == like.cone
            and np.array_equal(step.counts, like.counts)
            and len(step.extra.names) == len(like.extra.names)
        )
        self.fitting = step if fits else None
        return fits

    def answer(self, scaled: Scaled, accuracy: float) -> Answer:
        """What the backend says to a step, in natural units.

        Contacts out of reach are handed over nearer than they are, and bear no load.

        Raises
        ------
        StepNotSolved
            If it says anything but a full solution, or the numbers are not finite.
        """
        idle = self._write(scaled)
        if not self.rows:  # not every solver takes a program without rows
            x = np.asarray(np.linalg.solve(self.program.H, -self.program.f), dtype=np.float64)
            statistics = SolverStatistics(self.backend, "optimal", 0, None, accuracy)
            return Answer(x, np.zeros(0), statistics)
        accuracy = max(accuracy, BACKENDS[self.backend].floor)
        if accuracy not in self.attempts:
            options = BACKENDS[self.backend].attempts(accuracy)
            self.attempts[accuracy] = [_Attempt(one) for one in options]
        for attempt in self.attempts[accuracy]:
            reply = self._reply(attempt, scaled, accuracy)
            if reply.solved and finite(reply.x) and finite(reply.lam):
                break
        else:
            status = "an answer that is not finite" if reply.solved else reply.status
            raise StepNotSolved(self.backend, status, scaled.step, accuracy)
        if idle is not None:
            reply.lam[idle] = 0.0  # the judge, who sees the true gap, decides
        statistics = SolverStatistics(
            self.backend, "optimal", reply.iterations, reply.seconds, accuracy
        )
        return Answer(reply.x, reply.lam, statistics)

    def _write(self, scaled: Scaled) -> NDArray[np.bool_] | None:
        """Write the program in natural units; tell which rows are out of reach, if any is."""
        form, units, program = scaled.form, scaled.units, self.program
        S, ell, rho = units.coordinate, units.length, units.size
        if self.metric is not scaled.metric:
            np.multiply(form.H, S[:, None] * S, out=program.H)
            self.metric = scaled.metric
        np.multiply(form.g, S / -rho, out=program.f)
        np.multiply(form.A, S / ell, out=program.A)
        np.multiply(form.b, 1 / (rho * ell), out=program.b)
        if not self.adapter.NEAR or program.b.min(initial=0.0) >= -FAR:
            return None
        reach = -reach_of_rows(scaled.step, units)
        np.maximum(program.b, reach, out=program.b)
        return np.asarray(program.b == reach)

    def _reply(self, attempt: _Attempt, scaled: Scaled, accuracy: float) -> Reply:
        """One attempt: from the answer before, where there is one, and else or then cold."""
        try:
            if attempt.solver is None:
                attempt.solver = self.adapter(self.program, attempt.options)
                attempt.metric, attempt.warm = scaled.metric, False
            same_H = attempt.metric is scaled.metric
            reply = attempt.solver.reply(same_H, self.warm and attempt.warm)
            if not reply.solved and self.warm and attempt.warm:
                reply = attempt.solver.reply(False, False)
        except Exception as error:  # whatever another package raises
            attempt.solver = None
            status = f"the solver failed: {error}"
            raise StepNotSolved(self.backend, status, scaled.step, accuracy) from error
        attempt.metric, attempt.warm = scaled.metric, reply.solved
        return reply


@dataclass(eq=False)
class _Attempt:
    """A set of options with the solver that has them, once it is needed."""

    options: Options
    solver: Adapter | None = None
    metric: Metric | None = None
    warm: bool = False
