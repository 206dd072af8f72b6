"""A solver that is called step after step: what it keeps of the one before.

A simulation solves problems whose g, A and b all change a little; what a solver can keep of the
last one differs: its point, its point and multipliers, its active set, or its memory and factors
only. Which of these a solver takes is a fact of its interface.
"""

import importlib
import inspect
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from quasistatic_ref.lab.study.calling.calls import Call, Options, function_of, function_reply
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.solve.adapters.program import Adapter, Program, Reply
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.standard_form import StandardForm

COLD: Final = "cold"
MODES: Final = (COLD, "updates", "primal", "primal-dual", "active set")
"""Set up again each time; or from what was left: memory and factors alone, the point, the point
with its multipliers, the active set."""
NATIVE: Final = {"daqp": "active set", "osqp": "primal-dual"}
"""What the native adapters keep besides, where they start warm."""
QUIET: Final[dict[str, Options]] = {"osqp": {"verbose": False}}
KEEPS_NOTHING: Final = ("quadprog",)

Session = Callable[[StandardForm, Reply | None], Reply]
"""(the problem, the reply to the one before or None) -> reply."""


def modes_of(solver: Solver) -> tuple[str, ...]:
    """The modes in which a solver can be called; a callable is imported to know.

    Parameters
    ----------
    solver : Solver
        A callable may take ``start=(x, z)``.

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    name = str(solver.target)
    if solver.interface in ("package", "callable"):
        takes = "start" in inspect.signature(function_of(solver)).parameters
        return (COLD, "primal-dual") if takes else (COLD,)
    if solver.interface == "qpsolvers" and solver.warm:
        return (COLD, "primal")
    if solver.interface != "native" or name in KEEPS_NOTHING or name not in BACKENDS:
        return (COLD,)
    own = NATIVE.get(name)
    return (COLD, "updates", own) if own else (COLD, "updates")


def session_of(solver: Solver, mode: str, options: Options, call: Call, limit: float) -> Session:
    """A solver that begins a sequence.

    Parameters
    ----------
    solver : Solver
    mode : str
        One of :func:`modes_of`.
    options : dict
        In the solver's own names.
    call : callable
        The solver on a problem alone.
    limit : float
        Of a call [s].
    """
    if solver.interface == "native" and solver.target in BACKENDS:
        return Native(str(solver.target), mode, options)
    if mode == COLD:
        return lambda form, _: call(form, options, None, limit)
    if solver.interface == "qpsolvers":
        from quasistatic_ref.solve.through_qpsolvers import qpsolvers_reply  # heavy

        name = str(solver.target)
        return lambda form, before: qpsolvers_reply(
            form, name, options, None if before is None else before.x
        )
    return _started(function_of(solver), options)


class Native:
    """A native solver that is kept through a sequence, or set up again in each step.

    Parameters
    ----------
    name : str
        Of a backend with an adapter.
    mode : str
    options : dict
        In its own names.
    """

    def __init__(self, name: str, mode: str, options: Options) -> None:
        module = importlib.import_module(f"quasistatic_ref.solve.adapters.{name}")
        self.kind: type[Adapter] = getattr(module, BACKENDS[name].adapter)
        self.mode, self.options = mode, options | QUIET.get(name, {})
        self.adapter: Adapter | None = None

    def __call__(self, form: StandardForm, before: Reply | None) -> Reply:
        """The reply to the next problem."""
        if self.adapter is None or self.mode == COLD:
            order = self.kind.ORDER
            self.program = Program(form.H.copy(order=order), -form.g, form.A.copy(order=order),
                                   form.b.copy())  # fmt: skip
            self.adapter = self.kind(self.program, dict(self.options))
            return self.adapter.reply(same_H=True, warm=False)
        p = self.program
        same_H = np.array_equal(p.H, form.H)
        p.H[:], p.f[:], p.A[:], p.b[:] = form.H, -form.g, form.A, form.b
        return self.adapter.reply(same_H=same_H, warm=self.mode != "updates")


def _started(function: Callable[..., Any], options: Options) -> Session:
    """A function that starts from its own answer to the step before."""

    def call(form: StandardForm, before: Reply | None) -> Reply:
        if before is None or before.x is None or before.lam is None:
            return function_reply(function, form, options)
        start = (before.x.copy(), before.lam.copy())
        return function_reply(function, form, options | {"start": start})

    return call
