"""Six interfaces to a solver: CVXPY, qpsolvers, its own, a package, a callable, an executable."""

import contextlib
import inspect
import json
import shutil
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from scipy.sparse import issparse

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.lab.study.calling.options import Options, takes_sparse
from quasistatic_ref.lab.study.calling.packages import announced_function, function_at
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.lab.study.calling.study_only import natively
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

Call = Callable[[StandardForm, Options, Reply | None], Reply]
"""(problem, options, reply to start from or None) -> reply: to start from it is of a solver that
can; others look only at the problem."""

NO_LINE = "no usable JSON: the program ended without a line"
NEAR = 0.01
"""How far the neighbour's g is from the problem's, entry by entry and relative: a warm start comes
from the answer to the neighbour, as it does from the step before."""


def neighbour(form: StandardForm, name: str) -> StandardForm:
    """The problem that a warm start comes from: each g_i changed by up to 1 %.

    Parameters
    ----------
    form : StandardForm
    name : str
        Of the problem; the change is a function of it.

    Returns
    -------
    StandardForm
    """
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    return StandardForm(form.H, form.g * (1 + NEAR * rng.uniform(-1, 1, len(form.g))), form.A,
                        form.b)  # fmt: skip


def call_of(solver: Solver, folder: str = ".") -> Call:
    """The function that puts a problem to a solver, in matrices as its interface takes them.

    Parameters
    ----------
    solver : Solver
    folder : str
        Where an executable is looked for and runs.

    Raises
    ------
    InputError
        If a package, a callable or a guest cannot be imported, or there is no such executable.
    """
    call = _as_given(solver, folder)
    if takes_sparse(str(solver.target), solver.interface):
        return call
    return lambda form, options, before: call(_in_arrays(form), options, before)


def _in_arrays(form: StandardForm) -> StandardForm:
    """The same with H and A as arrays."""
    matrices: Iterable[Any] = (form.H, form.A)
    H, A = (M.toarray() if issparse(M) else M for M in matrices)
    return form._replace(H=H, A=A)


def _as_given(solver: Solver, folder: str) -> Call:
    """The same function, of matrices as they are."""
    name = str(solver.target)
    if solver.interface == "cvxpy":
        return _by_cvxpy(name)
    if solver.interface == "qpsolvers":
        return _directly(name)
    if solver.interface == "native":
        return _guest(name)
    if solver.interface in ("package", "callable"):
        return _function(function_of(solver))
    return Executable(_command(tuple(solver.target), folder), folder)


class Crashed(Exception):
    """An executable was ended by a signal, after some `seconds` [s]."""

    def __init__(self, words: str, seconds: float) -> None:
        self.seconds = seconds
        super().__init__(words)


def reply_or_failure(call: Callable[..., Reply], *given: Any) -> Reply:
    """The reply of a call; of one that raises, what it raised and when.

    Raises
    ------
    Crashed
        If an executable was ended by a signal.
    """
    begin = perf_counter()
    try:
        return call(*given)
    except Crashed:
        raise
    except Exception as error:  # whatever another package raises
        return _failed_reply(words_of(error), perf_counter() - begin)


def _failed_reply(words: str, seconds: float) -> Reply:
    return Reply(None, None, False, words, call_seconds=seconds)


def _by_cvxpy(name: str) -> Call:
    from quasistatic_ref.lab.study.calling.compiled_problems import CompiledProblems  # heavy: CVXPY

    programs = CompiledProblems(name)
    return lambda form, options, before: programs.reply(form, options, warm=before is not None)


def _directly(name: str) -> Call:
    from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply

    return lambda form, options, before: qpsolvers_reply(
        form, name, options, None if before is None else before.x
    )


def _guest(name: str) -> Call:
    native = natively(name)
    return lambda form, options, before: native(form, options)


def _function(function: Callable[..., Any]) -> Call:
    """A function, which starts from its own answer where it takes one."""
    starts = takes_start(function)

    def call(form: StandardForm, options: Options, before: Reply | None) -> Reply:
        if not starts or before is None or before.x is None or before.lam is None:
            return function_reply(function, form, options)
        start = (before.x.copy(), before.lam.copy())
        return function_reply(function, form, options | {"start": start})

    return call


def function_of(solver: Solver) -> Callable[..., Any]:
    """The function that a package announces, or that a module has.

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    target = str(solver.target)
    return announced_function(target) if solver.interface == "package" else function_at(target)


def takes_start(function: Callable[..., Any]) -> bool:
    """Whether a function takes ``start=(x, z)``; a compiled one may not say what it takes."""
    try:
        return "start" in inspect.signature(function).parameters
    except ValueError:
        return False


def function_reply(function: Callable[..., Any], form: StandardForm, options: Options) -> Reply:
    """What a function ``(P, q, G, h, **options) -> (x, z)`` returns."""
    P = form.H.copy()
    q = -form.g
    G = -form.A
    h = -form.b
    begin = perf_counter()
    returned = function(P, q, G, h, **options)
    seconds = perf_counter() - begin
    if returned is None or isinstance(returned, str):
        said = "returned None" if returned is None else returned
        return _failed_reply(" ".join(said.split())[:200], seconds)
    if not isinstance(returned, tuple | list) or len(returned) != 2:
        kind = type(returned).__name__
        kind += f" of {len(returned)}" if isinstance(returned, tuple | list) else ""
        said = f"returned a {kind} in place of (x, z), which have {len(q)} and {len(h)} numbers"
        return Reply(np.zeros((0, 0)), None, False, said, call_seconds=seconds)
    x, z = returned
    lam = None if z is None else _numbers(z)
    if isinstance(x, str):  # a claim that there is no solution, with what proves it
        return Reply(None, lam, False, x, call_seconds=seconds)
    return Reply(_numbers(x), lam, True, "returned", call_seconds=seconds)


def _command(words: tuple[str, ...], folder: str) -> tuple[str, ...]:
    program = shutil.which(words[0]) or shutil.which(str(Path(folder, words[0])))
    if program is None:
        raise InputError("there is no such program, or it may not be executed", value=words[0])
    return (program, *words[1:])


class Executable:
    """A program that answers each line of JSON with another: one process serves many problems.

    It is started at the first problem, and again where it has ended.

    Parameters
    ----------
    command : tuple of str
    folder : str
        Where it runs.
    """

    def __init__(self, command: tuple[str, ...], folder: str) -> None:
        self.command = command
        self.folder = folder
        self._process: subprocess.Popen[bytes] | None = None

    def __call__(self, form: StandardForm, options: Options, before: Reply | None) -> Reply:
        """The reply to a problem; options and a start are not handed on.

        Raises
        ------
        Crashed
            If the program was ended by a signal.
        """
        text = json_text({"H": form.H, "g": form.g, "A": form.A, "b": form.b}) + "\n"
        begin = perf_counter()
        was_there = self._process is not None
        line = self._answer(text.encode())
        if was_there and not line and self._status() == 0:  # it ended after the answer before
            line = self._answer(text.encode())
        seconds = perf_counter() - begin
        if line:
            return _reply_of_output(line, seconds)
        code = self._status()
        words = self._last_words()
        if code < 0:
            raise Crashed(f"killed by signal {-code}", seconds)
        return _failed_reply(f"exit status {code}: {words}"[:180] if code else NO_LINE, seconds)

    def _answer(self, text: bytes) -> bytes:
        """The line that the program writes; empty where it ends instead."""
        if self._process is None or self._process.poll() is not None:
            self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - of the process, and as long
            self._process = subprocess.Popen(
                self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors,
                cwd=self.folder,
            )  # fmt: skip
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(BrokenPipeError):  # its status says how it ended
            self._process.stdin.write(text)
            self._process.stdin.flush()
        return self._process.stdout.readline()

    def _status(self) -> int:
        assert self._process is not None
        return self._process.wait()

    def _last_words(self) -> str:
        self._errors.seek(0)
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        return " ".join(lines[-1:])


def _reply_of_output(output: bytes, seconds: float) -> Reply:
    """The reply in an executable's JSON."""
    try:
        said = json.loads(output)
        status = str(said.get("status", "optimal"))
        x = None if said.get("delta_q") is None else _numbers(said["delta_q"])
        lam = None if said.get("lam") is None else _numbers(said["lam"])
        own = None if said.get("seconds") is None else float(said["seconds"])
        iterations = None if said.get("iterations") is None else int(said["iterations"])
        solved = status == "optimal" and x is not None
        return Reply(x, lam, solved, status, iterations, own, seconds, own)
    except (ValueError, TypeError, AttributeError, RecursionError) as error:
        return _failed_reply(f"no usable JSON: {words_of(error)}", seconds)


def _numbers(values: Any) -> Array:
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        return np.zeros((0, 0))  # no numbers: a wrong shape


def words_of(error: Exception) -> str:
    """What was raised, on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]


def on_path(folder: str) -> None:
    """Make modules in a folder importable, as they are for ``python -m``."""
    if folder not in sys.path:
        sys.path.insert(0, folder)
