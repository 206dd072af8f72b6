"""A program that answers line by line, started again whenever it has to be.

Whatever it does, crash, hang, print what is no answer, answer twice, late or to a case that was not
sent, or flood its standard error, is survived and reported.
"""

import contextlib
import json
import math
import os
import queue
import shlex
import signal
import subprocess
import threading
import time
from dataclasses import dataclass
from typing import IO

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.supervised import Supervised
from quasistatic_ref.lab.vectors.check.answers import QUATERNIONS, TANGENTS, Answers
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS

START = 6.0
"""The first answer may take so many times longer [-]: a program starts, perhaps compiles itself."""
LINE = 64 * 2**20
"""Longest line of an answer [bytes]; the answer to 1,000 contacts has a hundredth."""
GRACE = 1.0
"""So many times the time for an answer [-] is a late one still waited for: then it is a hang."""
STRAY = 20
"""Lines that are no answer to the case, after which the program is started again."""
FLOOD = 2**20
"""Standard error beyond that [bytes] is said to be a flood."""
TAIL = 2000
"""The size of the part that is kept [bytes]."""


@dataclass(frozen=True)
class Reply:
    """What came of one question.

    Parameters
    ----------
    kind : str
        ``output``, ``error``, ``unsupported``; or what went wrong: ``crash``, ``hang``, ``late``,
        ``garbage``.
    output : object
        Of an ``output``.
    said : str
        Of an error, or of what went wrong.
    strays : tuple of str
        What else it answered meanwhile: twice, or to a case that was not sent.
    """

    kind: str
    output: Json = None
    said: str = ""
    strays: tuple[str, ...] = ()


class Program:
    """A program behind a command.

    Parameters
    ----------
    command : str
        As in a shell, without one.
    timeout : float
        For each answer [s].
    """

    def __init__(self, command: str, timeout: float = 10.0) -> None:
        try:
            self._words = shlex.split(command)
        except ValueError as error:
            raise InputError(f"cannot be read: {error}", field="command", value=command) from None
        if not self._words:
            raise InputError("is empty", field="command", value=command)
        self._timeout = timeout
        self._warming = (START - 1) * timeout
        self._process: Supervised | None = None
        self._heard = False
        self.until = math.inf
        """By the monotonic clock, when nobody waits for a slow start any more [s]."""
        self._answered: set[str] = set()
        self.said = Answers()
        self.layers: tuple[str, ...] = LAYERS
        self.flood = 0
        self.tail = b""
        self.starts = 0

    def __enter__(self) -> "Program":
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()

    def ask(self, id: str, layer: str, case: Json) -> Reply:
        """What it answers to a case.

        Raises
        ------
        InputError
            If the program cannot be started, or ends at its first start without an answer.
        """
        if self._process is None:
            self._start()
        began = time.monotonic()
        warming = 0.0 if self._heard else self._warming
        allowed = self._timeout + max(min(warming, self.until - began - self._timeout), 0.0)
        waited = allowed + GRACE * self._timeout
        line = json.dumps({"id": id, "layer": layer, "input": case}, allow_nan=False)
        self._inbox.put(line.encode() + b"\n")
        strays: list[str] = []
        while True:
            left = began + waited - time.monotonic()
            try:
                got = self._lines.get(timeout=max(left, 1e-3))
            except queue.Empty:
                self._stop()
                why = f"no answer within {waited:g} s; is each line flushed?"
                return Reply("hang", said=why, strays=tuple(strays))
            if got is None:
                return self._crash(strays)
            warming = not self._heard
            took = time.monotonic() - began
            reply = self._reply(id, got, strays)
            if reply is not None:
                if warming:  # started again, it may take twice that
                    self._warming = 2 * took
                return reply if took <= allowed else _late_reply(reply, took, allowed)
            if len(strays) >= STRAY:
                self._stop()
                return Reply("garbage", said=strays[0], strays=tuple(strays[:1]))

    def _reply(self, id: str, line: bytes, strays: list[str]) -> Reply | None:
        """The reply that a line is, if it is one to the case; otherwise what it is."""
        try:
            record = json.loads(line)
        except (ValueError, RecursionError):
            record = None
        if not isinstance(record, dict):
            text = line[:60].decode("utf-8", "replace").strip()
            strays.append(f"printed {text!r}, which is no JSON object on a line")
            return None
        if "protocol" in record and "id" not in record and not self._heard:
            self._greet(record)
            return None
        self._heard = True
        name = record.get("id")
        if name != id:
            twice = str(name) in self._answered
            what = f"{name!r} twice" if twice else f"{str(name)[:40]!r}, which was not sent"
            strays.append(f"answered {what}")
            return None
        self._answered.add(id)
        others = tuple(strays)
        if record.get("unsupported") is True:
            return Reply("unsupported", strays=others)
        if "error" in record:
            return Reply("error", said=str(record["error"])[:200], strays=others)
        if "output" in record:
            return Reply("output", output=record["output"], strays=others)
        said = "an answer has output, error or unsupported"
        return Reply("garbage", said=said, strays=others)

    def _greet(self, record: Json) -> None:
        """Read the line that declares what the program is."""
        top = TableReader(record, "the first line of the program")
        if top.take("protocol") != 1:
            raise top.error_about("protocol", "must be 1", record["protocol"])
        self.said = Answers(
            implementation=top.text("implementation", ""),
            tangent=top.text("tangent", "body", choices=TANGENTS),
            quaternion=top.text("quaternion", "xyzw", choices=QUATERNIONS),
        )
        supported = top.take("layers", list(LAYERS))
        top.close()
        self.layers = tuple(name for name in LAYERS if name in supported)

    def _crash(self, strays: list[str]) -> Reply:
        process = self._process
        heard = self._heard
        assert process is not None
        status = process.status()
        self._stop()
        how = "closed its output" if status is None else f"ended with status {status}"
        if status is not None and status < 0:
            how = f"ended by {signal.Signals(-status).name}"
        last = self.tail.decode("utf-8", "replace").strip().splitlines()
        said = f"{how}{': ' + last[-1][:160] if last else ''}"
        if not heard and self.starts == 1 and not strays:
            raise InputError(f"does not answer: it {said}", field="command", value=self._words[0])
        return Reply("crash", said=said, strays=tuple(strays))

    def _start(self) -> None:
        try:
            self._process = Supervised(self._words, subprocess.PIPE)
        except OSError as error:
            problem = f"cannot be started: {error.strerror or error}"
            raise InputError(problem, field="command", value=self._words[0]) from None
        self.starts += 1
        self._heard = False
        self._lines: queue.Queue[bytes | None] = queue.Queue(maxsize=1000)
        self._inbox: queue.Queue[bytes | None] = queue.Queue()
        own = self._process.process
        pipes = own.stdin, own.stdout, own.stderr
        assert all(pipe is not None for pipe in pipes)
        self._threads = [
            threading.Thread(target=target, args=arguments, daemon=True)
            for target, arguments in (
                (_send_lines, (pipes[0], self._inbox)),
                (_read, (pipes[1], self._lines)),
                (self._drain, (pipes[2],)),
            )
        ]
        for thread in self._threads:
            thread.start()

    def _drain(self, pipe: IO[bytes]) -> None:
        with contextlib.suppress(OSError, ValueError):
            while part := os.read(pipe.fileno(), 65536):
                self.flood += len(part)
                self.tail = (self.tail + part)[-TAIL:]

    def _stop(self) -> None:
        """End the program and all that it started, and what reads and feeds it."""
        process = self._process
        self._process = None
        if process is None:
            return
        self._inbox.put(None)
        process.end()
        until = (
            time.monotonic() + 1.0
        )  # what it started may hold its pipes, and be no child of ours
        while self._threads[1].is_alive() and time.monotonic() < until:
            with contextlib.suppress(queue.Empty):  # it may wait for room
                self._lines.get(timeout=0.02)
        own = process.process
        for thread, pipe in zip(self._threads, (own.stdin, own.stdout, own.stderr), strict=True):
            thread.join(timeout=1.0)
            if pipe is not None and not thread.is_alive():
                with contextlib.suppress(OSError, ValueError):
                    pipe.close()


def _late_reply(reply: Reply, took: float, allowed: float) -> Reply:
    """What an answer is that came too late: not judged."""
    said = f"answered after {took:.3g} s; {allowed:g} s are allowed"
    return Reply("late", said=said, strays=reply.strays)


def _send_lines(pipe: IO[bytes], lines: queue.Queue[bytes | None]) -> None:
    """Send the cases: a program that does not read holds up nobody else."""
    with contextlib.suppress(OSError, ValueError):
        while (line := lines.get()) is not None:
            pipe.write(line)
            pipe.flush()


def _read(pipe: IO[bytes], lines: queue.Queue[bytes | None]) -> None:
    """Read line by line; None at the end."""
    with contextlib.suppress(OSError, ValueError):
        while line := pipe.readline(LINE):
            if line.strip():
                lines.put(line)
    lines.put(None)
