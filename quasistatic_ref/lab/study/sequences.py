"""Sequences of steps asked in order: from cold, and from what the step before left.

A simulation asks problems whose g, A and b all change a little; what a solver can keep of the last
one differs: its point, its point and multipliers, its active set, or its memory and factors only.
Which of these a solver takes is a fact of its interface. What it does not take is refused, and
never left out in silence.
"""

import importlib
import inspect
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from quasistatic_ref.certify.digits import digits_of_error
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.calls import imported
from quasistatic_ref.lab.study.sets.member import Member
from quasistatic_ref.solve.adapters.program import Adapter, Program, Reply
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.solve.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

MODES: Final = ("cold", "updates", "primal", "primal-dual", "active set")
"""Set up anew each time; or from what was left: memory and factors alone, the point, the point
with its multipliers, the active set."""
NATIVE: Final = {"daqp": "active set", "osqp": "primal-dual"}
"""What the native adapters keep besides, where they start warm."""
QUIET: Final[dict[str, dict[str, Any]]] = {"osqp": {"verbose": False}}
KEEPS_NOTHING: Final = ("quadprog",)
QPSOLVERS = "qpsolvers:"

Session = Callable[[StandardForm, Reply | None], Reply]
"""(the problem, the reply to the one before or None) -> reply."""


@dataclass(frozen=True)
class Asked:
    """One problem of a sequence, asked in one way.

    Parameters
    ----------
    sequence : str
    place : int
    solver, mode : str
    solved : bool
        Whether it says so.
    said : str
    digits : float
        Correct ones [-]; 0 where it does not say solved.
    iterations : int or None
    seconds : float
        Of the whole call with the set-up that it needs, the median of the repetitions [s].
    """

    sequence: str
    place: int
    solver: str
    mode: str
    solved: bool
    said: str
    digits: float
    iterations: int | None
    seconds: float


def modes_of(solver: str) -> tuple[str, ...]:
    """The modes in which a solver can be asked.

    Parameters
    ----------
    solver : str
        A native backend's name, ``qpsolvers:NAME``, or ``module:function``: a callable
        ``(P, q, G, h) -> (x, z)`` that may take ``start=(x, z)``.

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
    if ":" in solver:
        takes = "start" in inspect.signature(imported(solver)).parameters
        return ("cold", "primal-dual") if takes else ("cold",)
    if solver not in installed("native"):
        raise InputError(f"is none of {', '.join(installed('native'))}, qpsolvers:NAME or "
                         "module:function", value=solver)  # fmt: skip
    if solver in KEEPS_NOTHING:
        return ("cold",)
    own = NATIVE.get(solver)
    return ("cold", "updates", own) if own else ("cold", "updates")


def checked(solvers: Sequence[str], modes: Sequence[str] | None) -> dict[str, tuple[str, ...]]:
    """The modes of each solver; those that are asked for, if all can do them.

    Raises
    ------
    InputError
        If a mode is unknown, or asked for and not possible.
    """
    found = {solver: modes_of(solver) for solver in solvers}
    for mode in modes or ():
        if mode not in MODES:
            raise InputError(f"is none of {', '.join(MODES)}", field="--modes", value=mode)
        for solver, own in found.items():
            if mode not in own:
                problem = f"cannot be asked of {solver}, which can {', '.join(own)}"
                raise InputError(problem, field="--modes", value=mode)
    return {solver: tuple(modes or own) for solver, own in found.items()}


def asked_in_order(
    sequences: Mapping[str, Sequence[Member]],
    modes: Mapping[str, Sequence[str]],
    accuracy: float,
    repetitions: int,
    seed: int = 1,
) -> Iterator[Asked]:
    """Every sequence asked of every solver in its modes.

    Parameters
    ----------
    sequences : mapping of str to sequence of Member
        In order, of equal shapes.
    modes : mapping of str to sequence of str
        Of each solver, as :func:`checked` returns them.
    accuracy : float
        In natural units [-].
    repetitions : int
        Of each sequence, whose times are medians.
    seed : int
        Of the order in which solvers and modes come, another one for each sequence.
    """
    rng = np.random.default_rng(seed)
    ways = [(solver, mode) for solver, own in modes.items() for mode in own]
    for name, members in sequences.items():
        forms, answers = in_one_unit(members)
        norms = [energy_norm(form.H) for form in forms]
        for i in rng.permutation(len(ways)):
            solver, mode = ways[i]
            runs = [list(_run(forms, solver, mode, accuracy)) for _ in range(repetitions)]
            for place, (form, exact, norm) in enumerate(zip(forms, answers, norms, strict=True)):
                reply = runs[0][place][0]
                found = _digits(norm, form, exact, reply)
                cost = float(np.median([run[place][1] for run in runs]))
                yield Asked(name, place, solver, mode, reply.solved, reply.status, found,
                            reply.iterations, cost)  # fmt: skip


def in_one_unit(members: Sequence[Member]) -> tuple[list[StandardForm], list[Array]]:
    """Problems and answers, shape (n,) each, in the natural units of the first one [-]."""
    units = members[0].units
    own = [Member(one.facts, one.H, one.g, one.A, one.b, units, one.answer).natural
           for one in members]  # fmt: skip
    return [one.form for one in own], [one.answer.x for one in own]


def _run(
    forms: Sequence[StandardForm], solver: str, mode: str, accuracy: float
) -> Iterator[tuple[Reply, float]]:
    """Replies to a sequence, and how long each took [s]."""
    session, before = _session(solver, mode, accuracy), None
    for form in forms:
        begin = time.perf_counter()
        before = session(form, before)
        yield before, time.perf_counter() - begin


def _session(solver: str, mode: str, accuracy: float) -> Session:
    if solver.startswith(QPSOLVERS):
        name = solver.removeprefix(QPSOLVERS)
        plain = BACKENDS[name].plain
        options = plain(accuracy) if plain else {}

        def through(form: StandardForm, before: Reply | None) -> Reply:
            start = before.x if mode == "primal" and before is not None else None
            return qpsolvers_reply(form, name, options, start)

        return through
    if ":" in solver:
        return _calling(imported(solver), warm=mode == "primal-dual")
    return Native(solver, mode, accuracy)


class Native:
    """A native solver that is kept through a sequence, or set up anew in each step.

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


def _digits(norm: EnergyNorm, form: StandardForm, exact: Array, reply: Reply) -> float:
    if not reply.solved or reply.x is None or not np.isfinite(reply.x).all():
        return 0.0
    free = float(norm.impulses(form.g[None])[0])
    off = norm.displacement(reply.x - exact)
    if free == 0:
        return 16.0 if off == 0 else 0.0
    return digits_of_error(off / free)
