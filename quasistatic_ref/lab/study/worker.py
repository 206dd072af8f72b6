"""A solver in a process of its own, which is ended where it exceeds a limit, and started again.

The process and whatever it starts are a group, which a guard, the first of the group, ends as soon
as the process that asks has ended, in whatever way.
"""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from time import perf_counter
from typing import Any, NamedTuple

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.processes import resident
from quasistatic_ref.lab.study.doors import Call, call_of
from quasistatic_ref.lab.study.row import CRASHED, MEMORY, TIMEOUT
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

TICK = 0.02
"""How often the limits of a call are looked at [s]."""
START = 60.0
"""In which a process must have imported its solver [s]."""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Set to 1, so that solvers are compared on one core each."""
PROGRAM = "from quasistatic_ref.lab.study.worker import serve; serve({})"
GUARD = ("sh", "-c", "read line; kill -9 0")
"""Waits until the other end of a pipe closes, and ends its group."""
GRACE = 5
"""In which a process that has closed its connection ends [s]."""


@dataclass(frozen=True, eq=False)
class Question:
    """What a process is asked.

    Parameters
    ----------
    form : StandardForm
    options : mapping
    calls : int
        How often the problem is put to the solver.
    start : StandardForm or None
        Each call starts from the answer to this neighbour.
    goes_on : bool
        Each call starts from the answer to the question before.
    is_kept : bool
        Whether the answer is one that the next question goes on from.
    """

    form: StandardForm
    options: Mapping[str, Any]
    calls: int = 1
    start: StandardForm | None = None
    goes_on: bool = False
    is_kept: bool = False


class Answer(NamedTuple):
    """What came back.

    Parameters
    ----------
    reply : Reply
        Of the first call.
    times : tuple of float
        Of all calls [s].
    started : bool
        Whether there was an answer to start from.
    """

    reply: Reply
    times: tuple[float, ...]
    started: bool


class Ended(Exception):
    """A process had to be ended, or ended itself.

    Parameters
    ----------
    outcome, words : str
    """

    def __init__(self, outcome: str, words: str) -> None:
        self.outcome = outcome
        super().__init__(words)


def serve(handle: int) -> None:
    """Answer questions until the other end of a pipe closes.

    Parameters
    ----------
    handle : int
        File descriptor of this end.
    """
    connection: Connection = Connection(handle)
    try:
        call = call_of(connection.recv())
    except InputError as error:
        connection.send(str(error))
        return
    connection.send("")
    before: Reply | None = None
    with contextlib.suppress(EOFError):
        while True:
            question = connection.recv()
            answer = answered(call, question, before)
            if question.is_kept:
                before = answer.reply
            connection.send(answer)


def answered(call: Call, question: Question, before: Reply | None) -> Answer:
    """Put a question to a solver.

    A step that was not solved starts nothing: what its solver left may be no point at all (OSQP's
    x of an infeasible step has entries of 2147483647).

    Parameters
    ----------
    call : callable
    question : Question
    before : Reply or None
        To the question that this one goes on from.
    """
    options: Options = dict(question.options)
    replies = []
    times = []
    for _ in range(question.calls):
        start = before if question.goes_on else None
        if question.start is not None:
            start = call(question.start, options, None)
        if start is not None and not start.solved:
            start = None
        begin = perf_counter()
        reply = call(question.form, options, start)
        times.append(reply.call_seconds or perf_counter() - begin)
        replies.append((reply, start is not None))
    reply, started = replies[0]
    return Answer(reply, tuple(times), started)


class SolverProcess:
    """The process of one solver, and its limits.

    Parameters
    ----------
    solver : Solver
    memory : float
        Most resident memory [bytes], where the system tells it (Linux).
    """

    def __init__(self, solver: Solver, memory: float) -> None:
        self.solver = solver
        self.memory = memory
        self.peak = 0.0
        self.kept = ""
        self._guard: subprocess.Popen[bytes]
        self._process: subprocess.Popen[bytes]
        self._connection: Connection | None = None

    def __enter__(self) -> "SolverProcess":
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def ask(self, question: Question, seconds: float) -> Answer:
        """The answer to a question, in a process that is started where there is none.

        Parameters
        ----------
        question : Question
        seconds : float
            Limit of all its calls [s].

        Raises
        ------
        Ended
            If a limit was exceeded, or the process ended.
        InputError
            If the solver cannot be imported.
        """
        if self._connection is None:
            self.start()
        assert self._connection is not None
        try:
            self._connection.send(question)
        except OSError:  # it ended by itself, after its last answer
            self.end()
            raise Ended(CRASHED, "ended before the call") from None
        answer: Answer = self._received(seconds)
        return answer

    def keep(self, name: str, question: Question, seconds: float) -> None:
        """Ask a question whose answer the next one may go on from, and remember its `name`.

        Parameters
        ----------
        name : str
        question : Question
        seconds : float
            Limit of all its calls [s].
        """
        self.ask(replace(question, is_kept=True), seconds)
        self.kept = name

    @property
    def is_there(self) -> bool:
        """Whether the process has been started, and not ended."""
        return self._connection is not None

    def end(self) -> None:
        """End the process, and what it has started."""
        if self._connection is not None:
            self._connection.close()
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._guard.pid, signal.SIGKILL)
            self._process.wait()
            with self._guard:  # closes its pipe, and waits for it
                pass
            self._connection = None
            self.kept = ""

    def start(self) -> None:
        """Start the process.

        Raises
        ------
        InputError
            If the solver cannot be imported.
        """
        self._connection, other = Pipe()
        path = {"PYTHONPATH": os.pathsep.join(sys.path)}
        nowhere = subprocess.DEVNULL  # what a solver prints
        # In a group of their own: Ctrl-C is for the study, which ends them.
        self._guard = subprocess.Popen(GUARD, stdin=subprocess.PIPE, process_group=0)
        self._process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM.format(other.fileno())],
            pass_fds=[other.fileno()],
            stdin=nowhere,
            stdout=nowhere,
            stderr=nowhere,
            env=os.environ | dict.fromkeys(THREADS, "1") | path,
            process_group=self._guard.pid,
        )
        other.close()
        self.peak = 0.0
        try:
            self._connection.send(self.solver)
            words = self._received(START)
        except Ended as end:
            raise InputError(f"cannot be started: {end}", value=self.solver.label) from None
        if words:
            self.end()
            raise InputError(words, field="solvers")

    def _received(self, seconds: float) -> Any:
        """What the process sends next."""
        assert self._connection is not None
        begin = perf_counter()
        while not self._connection.poll(TICK):
            passed = perf_counter() - begin
            used = resident(self._process.pid)
            self.peak = max(self.peak, used)
            if passed > seconds or used > self.memory:
                self.end()
                outcome = TIMEOUT if passed > seconds else MEMORY
                words = f"took {passed:.3g} s" if outcome == TIMEOUT else f"took {used:.3g} bytes"
                raise Ended(outcome, f"{words}, and was ended")
        try:
            received = self._connection.recv()
        except (EOFError, OSError):
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(GRACE)
            self.end()
            raise Ended(CRASHED, f"ended with {self._process.returncode}") from None
        self.peak = max(self.peak, resident(self._process.pid))
        return received
