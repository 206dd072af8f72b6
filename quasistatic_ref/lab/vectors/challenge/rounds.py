"""``vectors challenge``: rounds of new cases, from easy to hard.

Every case follows from the seed, the round, its layer and its number, so that the same program
gives the same result.
"""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from functools import partial
from multiprocessing import get_context

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.challenge.diagnosis import Diagnosis, Task
from quasistatic_ref.lab.vectors.challenge.fresh import EASY, HARD, PLAIN, fresh_case, record_of
from quasistatic_ref.lab.vectors.challenge.function import Function, Simulator
from quasistatic_ref.lab.vectors.challenge.outcome import Outcome
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import check_layer
from quasistatic_ref.lab.vectors.layers import LAYERS

ROUND = {
    "distance": 4, "selection": 4, "jacobian": 6, "rows": 6, "qp": 6, "wrench": 6,
    "integrate": 6, "step": 8, "derivative": 2,
}  # fmt: skip
"""Cases of each layer in a round."""


def challenge(
    program: Program | Simulator,
    *,
    layers: Sequence[str] | None = None,
    cases: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    digits: float | None = None,
    jobs: int = 1,
    first: bool = False,
    say: Callable[[str], None] = lambda line: None,
) -> Outcome:
    """Ask a program new cases, and say what it does wrong.

    Parameters
    ----------
    program : Program or callable
        Or a function (layer, input) -> output; None is the answer to what it does not support.
    layers : sequence of str, optional
        All by default; what the program does not support is left out.
    cases : int, optional
        How many at most; 1,000 if neither they nor the time is limited.
    seconds : float, optional
        Nothing is asked after that time; an answer that is awaited then is waited for [s].
    seed : int
    digits : float, optional
        [-] An answer that is right to so many digits is accepted.
    jobs : int
        Processes that make cases and their answers.
    first : bool
        Whether to end after the first round in which something is found.
    say : callable
        Called with a line on what is being done.

    Returns
    -------
    Outcome
    """
    names = [check_layer(name) for name in layers or LAYERS]
    began = time.monotonic()
    until = math.inf if seconds is None else began + seconds
    player = program if isinstance(program, Program) else Function(program)
    with ExitStack() as stack:
        if isinstance(player, Program):
            stack.enter_context(player)
            player.until = until
        makers: Callable[[Iterable[Task]], Iterator[tuple[Task, Json, Json]]] = _made_here
        if jobs > 1:
            pool = ProcessPoolExecutor(jobs, mp_context=get_context("spawn"))
            stack.callback(pool.shutdown, cancel_futures=True)
            makers = partial(pool.map, _task_and_case)
        found = Diagnosis(player, digits, makers, until)
        limit = 1000 if cases is None and seconds is None else cases
        number = 0
        while names and not found.full:
            left = None if limit is None else limit - found.outcome.sent.total()
            if found.late or (left is not None and left <= 0):
                break
            tasks = _round(names, seed, number)
            found.play(tasks if left is None else tasks[:left])
            say(f"round {number}: {found.outcome.sent.total()} cases, "
                f"{len(found.outcome.findings)} findings")  # fmt: skip
            names = [name for name in names if found.goes_on(name)]
            number += 1
            if first and found.outcome.findings:
                break
    return found.final_outcome()


def _round(names: Sequence[str], seed: int, number: int) -> list[Task]:
    """Easy cases, then plain ones, then both kinds that are harder in turn."""
    level = (EASY, PLAIN, HARD)[min(number, 2) if number < 3 else 1 + number % 2]
    return [(name, (seed, number, i), level) for name in names for i in range(ROUND[name])]


def _task_and_case(task: Task) -> tuple[Task, Json, Json]:
    return (task, *fresh_case(*task))


def _made_here(tasks: Iterable[Task]) -> Iterator[tuple[Task, Json, Json]]:
    return map(_task_and_case, tasks)


def sent_again(program: Program, finding: Json, digits: float | None = None) -> Outcome:
    """Ask the case of a counterexample once more.

    Parameters
    ----------
    program : Program
    finding : dict
        The record of a counterexample.
    digits : float, optional
        [-].

    Raises
    ------
    InputError
        If its case has no answer, or several.
    """
    layer = finding["layer"]
    case = finding["case"]
    found = Diagnosis(program, digits, _made_here)
    record = record_of(check_layer(layer), case)
    if record is None:
        raise InputError("is no input of the layer that has one answer", field="case")
    with program:
        found.outcome.sent[layer] += 1
        found.ask("again", layer, case, record)
    found.as_before(layer, tuple(finding["mistakes"]), tuple(finding["sentences"]))
    return found.final_outcome()
