"""A program that answers line by line; one that ends or hangs is started again."""

import contextlib
import json
import os
import shlex
import signal
import subprocess
import threading
from collections.abc import Callable
from dataclasses import dataclass

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.check.answers import QUATERNIONS, TANGENTS, Answers
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.text.json_text import plain
from quasistatic_ref.text.table_reader import TableReader

START = 6.0
"""The first answer may take so many times longer [-]: a program starts, perhaps compiles itself."""
LINE = 64 * 2**20
"""Longest line of an answer [bytes]; the answer to 1,000 contacts has a hundredth."""

Simulator = Callable[[str, Json], Json]
"""(layer, input) -> output, or None for a layer that it does not answer; arrays are lists."""


@dataclass(frozen=True)
class Reply:
    """A program's answer to one case, or why there is none.

    Parameters
    ----------
    kind : str
        ``output``, ``error``, ``unsupported``; or what went wrong: ``end``, ``hang``, ``garbage``.
    output : object
        Of an ``output``.
    reason : str
        Of an error, or of what went wrong.
    """

    kind: str
    output: Json = None
    reason: str = ""


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
        self._process: subprocess.Popen[bytes] | None = None
        self._answers_seen = 0
        self._starts = 0
        self.declaration = Answers()
        self.layers: tuple[str, ...] = LAYERS

    def __enter__(self) -> "Program":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def ask(self, id: str, layer: str, case: Json) -> Reply:
        """The program's answer to a case of a layer.

        Raises
        ------
        InputError
            If the program cannot be started, or ends at its first start without an answer.
        """
        process = self._process or self._start()
        seconds = self._timeout * (1 if self._answers_seen else START)
        hung = threading.Event()

        def end() -> None:
            hung.set()
            _kill(process)

        timer = threading.Timer(seconds, end)
        try:
            timer.start()
            reply = self._reply(process, id, {"id": id, "layer": layer, "input": case})
        finally:
            timer.cancel()
        if hung.is_set():
            self.close()
            return Reply("hang", reason=f"no answer within {seconds:g} s; is each line flushed?")
        if reply is None:
            return self._end(process)
        if reply.kind == "garbage":
            self.close()
        else:
            self._answers_seen += 1
        return reply

    def _reply(self, process: "subprocess.Popen[bytes]", id: str, question: Json) -> Reply | None:
        """Send a case and read a line; None if the program has ended."""
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(json.dumps(question, allow_nan=False).encode() + b"\n")
            process.stdin.flush()
        except OSError:
            return None
        line = process.stdout.readline(LINE)
        record = _record(line)
        if record and "protocol" in record and "id" not in record and not self._answers_seen:
            self._greet(record)
            line = process.stdout.readline(LINE)
            record = _record(line)
        if not line:
            return None
        if record is None:
            text = line[:60].decode("utf-8", "replace").strip()
            return Reply("garbage", reason=f"printed {text!r}, which is no JSON object on a line")
        if record.get("id") != id:
            name = str(record.get("id"))[:60]
            return Reply("garbage", reason=f"answered {name!r} where {id!r} was asked")
        if record.get("unsupported") is True:
            return Reply("unsupported")
        if "error" in record:
            return Reply("error", reason=str(record["error"])[:200])
        if "output" in record:
            return Reply("output", output=record["output"])
        return Reply("garbage", reason="an answer has output, error or unsupported")

    def _greet(self, record: Json) -> None:
        """Read the line that declares what the program is."""
        top = TableReader(record, "the first line of the program")
        if top.take("protocol") != 1:
            raise top.error_about("protocol", "must be 1", record["protocol"])
        self.declaration = Answers(
            implementation=top.text("implementation", ""),
            tangent=top.text("tangent", "body", choices=TANGENTS),
            quaternion=top.text("quaternion", "xyzw", choices=QUATERNIONS),
        )
        supported = top.take("layers", list(LAYERS))
        top.close()
        self.layers = tuple(name for name in LAYERS if name in supported)

    def _end(self, process: "subprocess.Popen[bytes]") -> Reply:
        """The reply that reports how a program's output ended."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(timeout=1.0)
        status = process.poll()
        self.close()
        how = "closed its output" if status is None else f"ended with status {status}"
        if status is not None and status < 0:
            how = f"ended by {signal.Signals(-status).name}"
        if self._starts == 1 and not self._answers_seen:
            raise InputError(f"does not answer: it {how}", field="command", value=self._words[0])
        return Reply("end", reason=how)

    def _start(self) -> "subprocess.Popen[bytes]":
        pipe = subprocess.PIPE
        try:
            process = subprocess.Popen(self._words, stdin=pipe, stdout=pipe, start_new_session=True)
        except OSError as error:
            problem = f"cannot be started: {error.strerror or error}"
            raise InputError(problem, field="command", value=self._words[0]) from None
        self._process = process
        self._answers_seen = 0
        self._starts += 1
        return process

    def close(self) -> None:
        """End the program and what it started; the next question starts it again."""
        process = self._process
        self._process = None
        if process is None:
            return
        _kill(process)
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):  # what was not yet written has no reader
                if pipe:
                    pipe.close()


class Function:
    """A Python function in the place of a program; what it raises counts as an error reply.

    Parameters
    ----------
    simulator : callable
    """

    declaration = Answers()
    layers: tuple[str, ...] = LAYERS

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator

    def ask(self, id: str, layer: str, case: Json) -> Reply:
        """The function's answer to a case of a layer."""
        try:
            output = self._simulator(layer, case)
        except Exception as error:
            return Reply("error", reason=f"{type(error).__name__}: {error}"[:200])
        return Reply("unsupported") if output is None else Reply("output", output=plain(output))

    def close(self) -> None:
        """There is nothing to end."""


def _record(line: bytes) -> Json:
    """The JSON object in a line; None if the line holds no JSON object."""
    try:
        record = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return record if isinstance(record, dict) else None


def _kill(process: "subprocess.Popen[bytes]") -> None:
    """Kill a program and all processes of its session."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
