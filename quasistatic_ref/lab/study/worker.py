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
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from time import perf_counter
from typing import Any, NamedTuple

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.processes import resident
from quasistatic_ref.lab.study.doors import Call, call_of
from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.solve.solver import Reply

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
    """A question to a solver's process: a program, options, and how many calls.

    Parameters
    ----------
    program : Program
    options : mapping
    calls : int
        How often the program is put to the solver.
    """

    program: Program
    options: Mapping[str, Any]
    calls: int = 1


class Answer(NamedTuple):
    """A solver process's answer to a question.

    Parameters
    ----------
    reply : Reply
        Of the first call.
    times : tuple of float
        Of all calls [s].
    """

    reply: Reply
    times: tuple[float, ...]


class Ended(Exception):
    """A process had to be ended, or ended itself.

    Parameters
    ----------
    words : str
    seconds : float
        How long it was asked [s].
    """

    def __init__(self, words: str, seconds: float) -> None:
        self.seconds = seconds
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
    with contextlib.suppress(EOFError):
        while True:
            connection.send(answered(call, connection.recv()))


def answered(call: Call, question: Question) -> Answer:
    """Put a question to a solver."""
    replies = []
    times = []
    for _ in range(question.calls):
        begin = perf_counter()
        reply = call(question.program, dict(question.options))
        times.append(reply.call_seconds or perf_counter() - begin)
        replies.append(reply)
    return Answer(replies[0], tuple(times))


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
            raise Ended("ended before the call", 0.0) from None
        answer: Answer = self._received(seconds)
        return answer

    @property
    def is_there(self) -> bool:
        """Whether the process has been started, and not ended."""
        return self._connection is not None

    def end(self) -> None:
        """End the worker process, and all processes that it has started."""
        if self._connection is not None:
            self._connection.close()
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._guard.pid, signal.SIGKILL)
            self._process.wait()
            with self._guard:  # closes its pipe, and waits for it
                pass
            self._connection = None

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
            if passed > seconds or used > self.memory:
                self.end()
                much = f"{passed:.3g} s" if passed > seconds else f"{used:.3g} bytes"
                raise Ended(f"took {much}, and was ended", passed)
        try:
            return self._connection.recv()
        except (EOFError, OSError):
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(GRACE)
            self.end()
            words = f"ended with {self._process.returncode}"
            raise Ended(words, perf_counter() - begin) from None
