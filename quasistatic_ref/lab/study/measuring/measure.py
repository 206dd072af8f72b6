"""Measurements: of a call, or of the calls on a sequence of steps.

A call is warmed up, graded once, and repeated as often as its time needs; a sequence is repeated
whole.

Calls of microseconds are timed in one exchange, by the clock of the solver's process, which the
solver could replace: the clock of the keeper, around the whole exchange, must confirm it. Calls
with a warm start cannot be confirmed, as the solves that they start from are in the same exchange.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.lab import processes
from quasistatic_ref.lab.study.calling.calls import neighbour
from quasistatic_ref.lab.study.calling.claims import INFEASIBLE
from quasistatic_ref.lab.study.calling.solvers import Setting
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.grade import (
    ProblemForms,
    grades,
    not_run,
    problem_forms,
    ungraded_fields,
)
from quasistatic_ref.lab.study.measuring.keeper import Ended, Keeper, Request, exchange
from quasistatic_ref.lab.study.measuring.messages import Response
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.store.rows import CRASHED, MEMORY, SOLVED, TIMEOUT, Row
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array

LONG = 2e-3
"""An exchange of calls lasts that long, if `MOST` times the repetitions suffice [s]."""
MOST = 10
TRIES = 3
"""Exchanges of which one must bear the solver's clock out: another program may hold one up."""
BORNE = 0.5
"""Share of an exchange, beyond what an empty one takes, that the calls in it must account for..."""
NOISE = 2e-4
"""...but for that [s]: messages of this size are written and read in less."""

ALIKE = 1e-9
"""Two answers are the same within that of their largest entry: g differs by up to 1e-2."""
NEARER = 1e3
"""Ratio of its errors from which an answer is to the step before, and not to its own: both are of
one solver, so that errors of its own differ less."""


def measured_row(
    keeper: Keeper, problem: Problem, setting: Setting, units: str, warm: bool, limits: Limits
) -> Row:
    """Run one solver on one problem; whatever it does, fields of a row come back.

    Parameters
    ----------
    keeper : Keeper
    problem : Problem
    setting : Setting
    units : str
    warm : bool
    limits : Limits

    Returns
    -------
    dict

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    begin = perf_counter()
    keeper.start()
    seconds: dict[str, float | None] = {"start": perf_counter() - begin, "warm_up": None}
    ready = problem_forms(problem)
    form = ready.forms[units]
    other = neighbour(form, problem.id).g
    start = other if warm else None
    assert keeper.pid is not None  # it was started
    processes.reset_peak(keeper.pid)
    begin = perf_counter()
    memory = None
    shape = (*form.A.shape, units, setting.name, warm)
    try:
        exchange(keeper, form, setting)
        if shape not in keeper.seen:
            keeper.answer(form, Request(setting, limits.warm_up, g=other, start=start))
            keeper.seen.add(shape)
            seconds["warm_up"] = perf_counter() - begin
        begin = perf_counter()
        row = _graded_row(
            keeper, ready, Request(setting, limits.time_limit, start=start), units, limits
        )
        memory = None if keeper.pid is None else processes.peak(keeper.pid)
    except Ended as end:
        if seconds["warm_up"] is None and shape not in keeper.seen:
            seconds["warm_up"] = end.seconds
        row = ungraded_fields(end.outcome, end.words, end.seconds, problem.feasible)
    keeper.tidy()
    seconds["spent"] = perf_counter() - begin
    return row | {"seconds": row["seconds"] | seconds, "memory": memory}


def sequence_measured(
    keeper: Keeper,
    problems: Sequence[Problem],
    setting: Setting,
    units: str,
    mode: str,
    limits: Limits,
    left: float,
) -> list[Row]:
    """Run one solver on steps in order, each from what it kept of the one before.

    A process that has to be ended starts again, cold, at the next step.

    Parameters
    ----------
    keeper : Keeper
    problems : sequence of Problem
        Of equal shapes; all are put in the natural units of the first.
    setting : Setting
    units : str
    mode : str
    limits : Limits
    left : float
        Of the solver's budget [s]: steps beyond it are not run.

    Returns
    -------
    list of dict
        Fields of a row for each problem: the worst answer of the repetitions, quartiles of times.

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    ready = [problem_forms(replace(one, units=problems[0].units)) for one in problems]
    turns: list[list[Row]] = []
    for _ in range(limits.repetitions):
        turn: list[Row] = []
        x: Array | None = None
        for place, one in enumerate(ready):
            first = not turn or turn[-1]["outcome"] in (CRASHED, TIMEOUT, MEMORY)
            request = Request(setting, limits.time_limit, mode=mode, first=first)
            shape = (*one.forms[units].A.shape, setting.name, units, mode, min(place, 1))
            if left <= 0:
                row = not_run(not one.answer.farkas)
            else:
                last = x
                row, x = _step(keeper, one, request, units, shape, limits.warm_up)
                if place:
                    row["repeats"] = _repeats(one, ready[place - 1], x, last)
            left -= row["seconds"]["spent"]
            turn.append(row)
        turns.append(turn)
    return [_worst(repeated) for repeated in zip(*turns, strict=True)]


def _repeats(
    one: ProblemForms, before: ProblemForms, x: Array | None, last: Array | None
) -> bool | None:
    """Whether x is the last answer again, or answers the step before; None: cannot be known."""
    exact = one.answer.x
    old = before.answer.x
    if x is None or not x.shape == exact.shape == old.shape or np.array_equal(exact, old):
        return None
    off, off_before = (one.norm.of_displacement(x - answer) for answer in (exact, old))
    same = last is not None and np.array_equal(x, last)
    return same or bool(NEARER * off_before <= off)


def _step(
    keeper: Keeper, ready: ProblemForms, request: Request, units: str, shape: object, warm_up: float
) -> tuple[Row, Array | None]:
    """One call on the next step of a sequence, and the x that it returned."""
    form = ready.forms[units]
    try:
        keeper.start()
        exchange(keeper, form, request.setting)
        limit = request.limit if shape in keeper.seen else warm_up
        response, outside = keeper.answer(form, replace(request, limit=limit))
    except Ended as end:
        row = ungraded_fields(end.outcome, end.words, end.seconds, not ready.answer.farkas)
        row["seconds"]["spent"] = end.seconds
        return row, None
    finally:
        keeper.tidy()
    keeper.seen.add(shape)
    beyond = outside - keeper.exchange
    agrees = borne_out(response.times, beyond)
    row = grades(ready, units, response.reply, keeper.solver, request.setting)
    row["seconds"] |= {"call": response.times[0] if agrees else beyond, "spent": outside}
    return row | {"calls": 1, "clock_agrees": agrees}, response.reply.x


def _worst(repeated: Sequence[Row]) -> Row:
    """The worst row of a step that was repeated, with quartiles of its times."""
    times = [row["seconds"]["call"] for row in repeated if row["seconds"]["call"] is not None]
    spent = sum(row["seconds"]["spent"] for row in repeated)
    clocks: Row = {"spent": spent}
    if times:
        clocks |= {"first": times[0], **_quartiles(times)}
    row = min(repeated, key=_goodness)
    calls = sum(one["calls"] for one in repeated)
    return row | {"calls": calls, "seconds": row["seconds"] | clocks}


def _graded_row(
    keeper: Keeper, ready: ProblemForms, request: Request, units: str, limits: Limits
) -> Row:
    """The worse of the first and the last graded reply, with quartiles of the repeated calls."""
    form = ready.forms[units]
    solver = keeper.solver
    response, outside = keeper.answer(form, request)
    row = grades(ready, units, response.reply, solver, request.setting)
    row["seconds"]["first"] = response.times[0]
    if row["outcome"] == SOLVED:
        row = _row_with_copy(keeper, ready, request, units, row, response.reply)
    first = row["seconds"]["first"]
    repeats = row["repeats"]
    if not response.reply.solved and solver.claim(response.reply.status) != INFEASIBLE:
        return row | {"calls": 1}
    again, times, agrees = _timed_reply(keeper, form, request, outside, limits)
    other = grades(ready, units, again.reply, solver, request.setting)
    row = min(row, other, key=_goodness)
    row |= {"calls": len(times), "clock_agrees": agrees, "repeats": repeats}
    clocks = {"first": first, **_quartiles(times)}
    clocks |= {name: other["seconds"][name] for name in ("setup", "solver")}  # as warm as these
    return row | {"seconds": row["seconds"] | clocks}


def _row_with_copy(
    keeper: Keeper, ready: ProblemForms, request: Request, units: str, row: Row, found: Reply
) -> Row:
    """A row with the time of a call on a copy of the problem, which its process sees once.

    The copy has another g, of which no answer with multipliers can be the same. ``repeats`` says
    that the solver returns the answer that it found to the problem, or does not solve the copy.
    """
    form = ready.forms[units]
    copy = neighbour(form, f"copy/{request.setting.name}/{form.g.tobytes().hex()}")
    try:
        response, _ = keeper.answer(form, replace(request, g=copy.g))
    except Ended:
        return row
    reply = response.reply
    same = reply.solved and all(map(_are_alike, (reply.x, reply.lam), (found.x, found.lam)))
    seconds = row["seconds"] | {"first": response.times[0]}
    return row | {"repeats": same or not reply.solved, "seconds": seconds}


def _are_alike(one: Array | None, other: Array | None) -> bool:
    if one is None or other is None or one.shape != other.shape:
        return False
    return bool((abs(one - other) <= ALIKE * abs(other).max(initial=0.0)).all())


def _quartiles(times: Sequence[float]) -> dict[str, float]:
    low, call, high = np.percentile(times, [25, 50, 75]).tolist()
    return {"low": low, "call": call, "high": high}


def borne_out(times: Sequence[float], beyond: float) -> bool:
    """Whether a solver's own times [s] account for an exchange, beyond an empty one [s]."""
    return sum(times) >= BORNE * beyond - NOISE


def _goodness(row: Row) -> tuple[bool, bool, float]:
    """What a repeated call is judged by: the worst answer counts."""
    return not row["wrong"], row["said_optimal"], row["digits"]["delta_q"] or 0.0


def _timed_reply(
    keeper: Keeper, form: Any, request: Request, outside: float, limits: Limits
) -> tuple[Response, tuple[float, ...], bool | None]:
    """Calls in one exchange: the last reply, their times [s], whether the keeper's clock agrees.

    Where it does not, each call took its share of the shortest exchange. With a warm start the two
    clocks are not compared, and the third is None.
    """
    about = max(outside - keeper.exchange, 1e-6)
    count = min(max(math.ceil(LONG / about), limits.repetitions), MOST * limits.repetitions)
    many = Request(request.setting, request.limit, count, start=request.start)
    shortest = math.inf
    for _ in range(TRIES):
        response, whole = keeper.answer(form, many)
        beyond = whole - keeper.exchange
        shortest = min(shortest, beyond)
        if request.start is not None:
            return response, response.times, None
        if borne_out(response.times, beyond):
            return response, response.times, True
    return response, (shortest / count,) * count, False
