"""Sequences of steps solved in order: from cold, and from what the step before left.

Each solver has a process of its own, with limits of time and memory: one that hangs, crashes or
eats memory is started again, cold, at the next step, and costs itself only. What a solver cannot
start from is refused, and never left out in silence.
"""

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from quasistatic_ref.certify.digits import digits_of_error
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.calling import sessions
from quasistatic_ref.lab.study.calling.sessions import MODES, is_foreign
from quasistatic_ref.lab.study.calling.solvers import Setting
from quasistatic_ref.lab.study.measuring.grade import CRASHED, FAILED, NOT_RUN, SOLVED
from quasistatic_ref.lab.study.measuring.keeper import Ended, Keeper, Request, exchange
from quasistatic_ref.lab.study.measuring.measure import Limits, borne_out
from quasistatic_ref.lab.study.problems.problem import Member
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

WORKER = "quasistatic_ref.lab.study.measuring.sequence_worker"


@dataclass(frozen=True)
class SequenceRow:
    """One problem of a sequence, solved in one mode.

    Parameters
    ----------
    sequence : str
    place : int
    solver, mode : str
    outcome : str
        As in a study: solved, failed, crashed, timeout, memory, or not_run_budget.
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
    outcome: str
    said: str
    digits: float
    iterations: int | None
    seconds: float

    @property
    def solved(self) -> bool:
        """Whether it says so."""
        return self.outcome == SOLVED


@dataclass(frozen=True)
class SolverLimits(Limits):
    """What a call may take, and a solver in all its calls.

    Parameters
    ----------
    call, warm_up : float
        Of a call, and of one at a sequence's beginning [s].
    repetitions : int
        Of a whole sequence.
    memory : float
        Of its processes [bytes].
    budget : float
        Of all its calls [s].
    """

    call: float = 2.0
    memory: float = 4e9
    budget: float = 600.0


LIMITS: Final = SolverLimits()


@dataclass(frozen=True)
class Step(Request):
    """A request of the next step; `first` begins a sequence, in the mode that the setting names."""

    first: bool = False


@dataclass(frozen=True)
class Named:
    """What the process of a solver is sent first."""

    name: str


@dataclass(eq=False)
class _Caller:
    """One solver's process, and what is left of its budget [s]."""

    keeper: Keeper
    limits: SolverLimits
    left: float
    seen: set[object] = field(default_factory=set)

    def next(
        self, form: StandardForm, setting: Setting, first: bool, place: int
    ) -> tuple[Reply, str, float]:
        """Reply and outcome of the next step, and how long it took [s]."""
        if self.left <= 0:
            return Reply(None, None, False, "not run (budget)"), NOT_RUN, 0.0
        shape = (*form.A.shape, setting.name, min(place, 1))
        limit = self.limits.call if shape in self.seen else self.limits.warm_up
        try:
            self.keeper.start()
            exchange(self.keeper, form, setting)
            response, outside = self.keeper.answer(form, Step(setting, limit, first=first))
        except InputError as error:  # it could be imported before
            self.left = 0.0
            return Reply(None, None, False, error.problem), CRASHED, 0.0
        except Ended as end:
            self.left -= end.seconds
            return Reply(None, None, False, end.words), end.outcome, end.seconds
        finally:
            self.keeper.tidy()
        self.seen.add(shape)
        self.left -= outside
        beyond = outside - self.keeper.exchange
        seconds = response.times[0] if borne_out(response.times, beyond) else beyond
        return response.reply, SOLVED if response.reply.solved else FAILED, seconds


def modes_of(solver: str, folder: str | Path = ".") -> tuple[str, ...]:
    """The modes in which a solver can be called; a callable is imported in a process of its own.

    Parameters
    ----------
    solver : str
        As :func:`~.sessions.modes_of` takes it.
    folder : str or Path
        Where callables are looked for.

    Raises
    ------
    InputError
        If there is no such solver here, or it cannot be imported.
    """
    if not is_foreign(solver):
        return sessions.modes_of(solver)
    one = np.ones((1, 1))
    form = StandardForm(one, one[0], one, one[0])
    with Keeper(Named(solver), folder, worker=WORKER) as keeper:
        try:
            response, _ = keeper.answer(form, Request(Setting("cold", 1.0, 0.0), 1.0, count=0))
        except Ended as end:
            raise InputError(f"did not say what it takes: {end.words}", value=solver) from None
    return tuple(response.reply.status.split(","))


def checked(
    solvers: Sequence[str], modes: Sequence[str] | None, folder: str | Path = "."
) -> dict[str, tuple[str, ...]]:
    """The modes of each solver; those that are named, if all can do them.

    Raises
    ------
    InputError
        If a mode is unknown, or named and not possible.
    """
    found = {solver: modes_of(solver, folder) for solver in solvers}
    for mode in modes or ():
        if mode not in MODES:
            raise InputError(f"is none of {', '.join(MODES)}", field="--modes", value=mode)
        for solver, own in found.items():
            if mode not in own:
                problem = f"is no mode of {solver}, which has {', '.join(own)}"
                raise InputError(problem, field="--modes", value=mode)
    return {solver: tuple(modes or own) for solver, own in found.items()}


def sequence_rows(
    sequences: Mapping[str, Sequence[Member]],
    modes: Mapping[str, Sequence[str]],
    accuracy: float,
    limits: SolverLimits = LIMITS,
    seed: int = 1,
    folder: str | Path = ".",
) -> Iterator[SequenceRow]:
    """Every solver run on every sequence, in each of its modes.

    Parameters
    ----------
    sequences : mapping of str to sequence of Member
        In order, of equal shapes.
    modes : mapping of str to sequence of str
        Of each solver, as :func:`checked` returns them.
    accuracy : float
        In natural units [-].
    limits : SolverLimits
        Of its repetitions times are medians, and of their answers the worst counts.
    seed : int
        Of the order in which solvers and modes come, another one for each sequence.
    folder : str or Path
        Where callables are looked for.
    """
    rng = np.random.default_rng(seed)
    ways = [(solver, mode) for solver, own in modes.items() for mode in own]
    with contextlib.ExitStack() as stack:
        callers = {}
        for solver in modes:
            keeper = Keeper(Named(solver), folder, limits.memory, WORKER)
            callers[solver] = _Caller(stack.enter_context(keeper), limits, limits.budget)
        for name, members in sequences.items():
            forms, answers = in_one_unit(members)
            norms = [energy_norm(form.H) for form in forms]
            for i in rng.permutation(len(ways)):
                solver, mode = ways[i]
                setting = Setting(mode, accuracy, 0.0)
                turns = range(limits.repetitions)
                runs = [list(_run(forms, callers[solver], setting)) for _ in turns]
                for place, (form, exact, norm) in enumerate(
                    zip(forms, answers, norms, strict=True)
                ):
                    own = [(*run[place], _digits(norm, form, exact, run[place][0])) for run in runs]
                    reply, outcome, _, found = min(own, key=lambda one: (one[0].solved, one[3]))
                    cost = float(np.median([seconds for _, _, seconds, _ in own]))
                    yield SequenceRow(name, place, solver, mode, outcome, reply.status, found,
                                      reply.iterations, cost)  # fmt: skip


def in_one_unit(members: Sequence[Member]) -> tuple[list[StandardForm], list[Array]]:
    """Problems and answers, shape (n,) each, in the natural units of the first one [-]."""
    units = members[0].units
    own = [Member(one.facts, one.H, one.g, one.A, one.b, units, one.answer).natural
           for one in members]  # fmt: skip
    return [one.form for one in own], [one.answer.x for one in own]


def _run(
    forms: Sequence[StandardForm], caller: _Caller, setting: Setting
) -> Iterator[tuple[Reply, str, float]]:
    """Replies to a sequence, how they ended, and how long each took [s]."""
    first = True
    for place, form in enumerate(forms):
        found = caller.next(form, setting, first, place)
        first = found[1] not in (SOLVED, FAILED)  # its process was ended
        yield found


def _digits(norm: EnergyNorm, form: StandardForm, exact: Array, reply: Reply) -> float:
    usable = reply.x is not None and reply.x.shape == form.g.shape
    if not reply.solved or reply.x is None or not usable or not np.isfinite(reply.x).all():
        return 0.0
    free = float(norm.impulses(form.g[None])[0])
    off = norm.displacement(reply.x - exact)
    if free == 0:
        return 16.0 if off == 0 else 0.0
    return digits_of_error(off / free)
