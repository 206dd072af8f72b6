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

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.calling.calls import imported
from quasistatic_ref.lab.study.calling.packages import loaded
from quasistatic_ref.solve.adapters.program import Adapter, Program, Reply
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.step.standard_form import StandardForm

MODES: Final = ("cold", "updates", "primal", "primal-dual", "active set")
"""Set up again each time; or from what was left: memory and factors alone, the point, the point
with its multipliers, the active set."""
NATIVE: Final = {"daqp": "active set", "osqp": "primal-dual"}
"""What the native adapters keep besides, where they start warm."""
QUIET: Final[dict[str, dict[str, Any]]] = {"osqp": {"verbose": False}}
KEEPS_NOTHING: Final = ("quadprog",)
QPSOLVERS, PACKAGE = "qpsolvers:", "package:"

Session = Callable[[StandardForm, Reply | None], Reply]
"""(the problem, the reply to the one before or None) -> reply."""


def modes_of(solver: str) -> tuple[str, ...]:
    """The modes in which a solver can be called; a callable is imported to know.

    Parameters
    ----------
    solver : str
        A native backend's name, ``qpsolvers:NAME``, ``package:NAME`` or ``module:function``: the
        last two are callables ``(P, q, G, h) -> (x, z)`` that may take ``start=(x, z)``.

    Raises
    ------
    InputError
        If there is no such solver here.
    """
    if solver.startswith(QPSOLVERS):
        name = solver.removeprefix(QPSOLVERS)
        if name not in installed("qpsolvers"):
            raise InputError("is not a solver that qpsolvers reaches here", value=solver)
        return ("cold", "primal") if "qpsolvers" in BACKENDS[name].warm else ("cold",)
    if is_foreign(solver):
        takes = "start" in inspect.signature(_function(solver)).parameters
        return ("cold", "primal-dual") if takes else ("cold",)
    if solver not in installed("native"):
        raise InputError(f"is none of {', '.join(installed('native'))}, qpsolvers:NAME, "
                         "package:NAME or module:function", value=solver)  # fmt: skip
    if solver in KEEPS_NOTHING:
        return ("cold",)
    own = NATIVE.get(solver)
    return ("cold", "updates", own) if own else ("cold", "updates")


def is_foreign(solver: str) -> bool:
    """Whether the code of a solver comes from outside, and may do anything."""
    return ":" in solver and not solver.startswith(QPSOLVERS)


def session_of(solver: str, mode: str, accuracy: float) -> Session:
    """A solver that begins a sequence.

    Parameters
    ----------
    solver, mode : str
    accuracy : float
        In the units of the problems [-].

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    if solver.startswith(QPSOLVERS):
        from quasistatic_ref.solve.through_qpsolvers import qpsolvers_reply  # heavy

        name = solver.removeprefix(QPSOLVERS)
        plain = BACKENDS[name].plain
        options = plain(accuracy) if plain else {}

        def through(form: StandardForm, before: Reply | None) -> Reply:
            start = before.x if mode == "primal" and before is not None else None
            return qpsolvers_reply(form, name, options, start)

        return through
    if is_foreign(solver):
        return _calling(_function(solver), warm=mode == "primal-dual")
    return Native(solver, mode, accuracy)


def _function(solver: str) -> Callable[..., Any]:
    own = solver.startswith(PACKAGE)
    return loaded(solver.removeprefix(PACKAGE)) if own else imported(solver)


class Native:
    """A native solver that is kept through a sequence, or set up again in each step.

    Parameters
    ----------
    name : str
        Of a backend with an adapter.
    mode : str
    accuracy : float
        In the units of the problems [-].
    """

    def __init__(self, name: str, mode: str, accuracy: float) -> None:
        module = importlib.import_module(f"quasistatic_ref.solve.adapters.{name}")
        self.kind: type[Adapter] = getattr(module, BACKENDS[name].adapter)
        plain = BACKENDS[name].plain
        self.mode, self.options = mode, (plain(accuracy) if plain else {}) | QUIET.get(name, {})
        self.adapter: Adapter | None = None

    def __call__(self, form: StandardForm, before: Reply | None) -> Reply:
        """The reply to the next problem."""
        if self.adapter is None or self.mode == "cold":
            order = self.kind.ORDER
            self.program = Program(form.H.copy(order=order), -form.g, form.A.copy(order=order),
                                   form.b.copy())  # fmt: skip
            self.adapter = self.kind(self.program, dict(self.options))
            return self.adapter.reply(same_H=True, warm=False)
        p = self.program
        same_H = np.array_equal(p.H, form.H)
        p.H[:], p.f[:], p.A[:], p.b[:] = form.H, -form.g, form.A, form.b
        return self.adapter.reply(same_H=same_H, warm=self.mode != "updates")


def _calling(function: Callable[..., Any], warm: bool) -> Session:
    def call(form: StandardForm, before: Reply | None) -> Reply:
        start = {}
        if warm and before is not None and before.x is not None and before.lam is not None:
            start = {"start": (before.x.copy(), before.lam.copy())}
        try:
            returned = function(form.H.copy(), -form.g, -form.A, -form.b, **start)
            if returned is None:
                return Reply(None, None, False, "returned None")
            x, lam = (np.array(part, dtype=np.float64) for part in returned)
        except Exception as error:  # whatever a user's solver raises
            return Reply(None, None, False, f"{type(error).__name__}: {error}"[:200])
        good = x.shape == form.g.shape and lam.shape == form.b.shape
        return Reply(x, lam, True, "returned") if good else Reply(None, None, False, "wrong shape")

    return call
