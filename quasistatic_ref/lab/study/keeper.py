"""The keeper of one solver's process: start, question, kill when it hangs, start again."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import quasistatic_ref
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.grade import CRASHED, TIMEOUT, ungraded
from quasistatic_ref.lab.study.qp import Problem
from quasistatic_ref.lab.study.solvers import Setting, Solver

WORKER = "quasistatic_ref.lab.study.worker"
"""The module that runs in a solver's process."""

START = 120.0
"""Longest that a process may take to import its solver [s]."""

EXTRA = 0.5
"""What a process may take beyond the time limit, for solvers that stop themselves [s]."""

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS",
     "VECLIB_MAXIMUM_THREADS", "NUMEXPR_NUM_THREADS"), "1",
)  # fmt: skip
"""Each solver has one core, or times could not be compared."""


class Keeper:
    """One solver's process, alive from its first question on.

    Parameters
    ----------
    solver : Solver
    folder : str or Path
        Where a callable's module is looked for, besides the usual places.
    """

    def __init__(self, solver: Solver, folder: str | Path = ".") -> None:
        self.solver, self.folder = solver, str(Path(folder).resolve())
        self._process: subprocess.Popen[bytes] | None = None
        self._problem: str | None = None
        self.starts = 0

    def measured(
        self, problem: Problem, setting: Setting, units: str, warm: bool, limit: float
    ) -> dict[str, Any]:
        """Ask once; whatever the solver does, fields of a row come back.

        Parameters
        ----------
        problem : Problem
        setting : Setting
        units : str
        warm : bool
        limit : float
            Seconds after which the process is killed; a warm start may take as long before.

        Returns
        -------
        dict

        Raises
        ------
        InputError
            If the solver cannot be imported.
        """
        self._started()
        request = {"setting": setting, "units": units, "warm": warm, "limit": limit}
        begin = time.perf_counter()
        try:
            if self._problem != problem.id:
                self._outbox.send(problem)
                self._problem = problem.id
            self._outbox.send(request)
            if self._inbox.poll((1 + warm) * limit + EXTRA):
                reply: dict[str, Any] = self._inbox.recv()
                return reply
        except (EOFError, OSError):
            return ungraded(CRASHED, self._ended(), time.perf_counter() - begin)
        self.close()
        return ungraded(TIMEOUT, f"killed after {limit:g} s", time.perf_counter() - begin)

    def close(self) -> None:
        """End the process."""
        if self._process is None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._inbox.close()
        self._outbox.close()
        self._process = None

    def __enter__(self) -> "Keeper":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _started(self) -> None:
        if self._process is not None:
            return
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        root = str(Path(quasistatic_ref.__file__).parents[1])
        path = os.pathsep.join([root, *filter(None, [os.environ.get("PYTHONPATH")])])
        self._process = subprocess.Popen(
            [sys.executable, "-m", WORKER, str(theirs_in), str(theirs_out)],
            pass_fds=(theirs_in, theirs_out),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,  # solvers print
            stderr=subprocess.DEVNULL,
            env=os.environ | ONE_THREAD | {"PYTHONPATH": path},
            start_new_session=True,  # an executable that it runs is killed with it
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self._inbox = Connection(ours_in, writable=False)
        self._outbox = Connection(ours_out, readable=False)
        self._problem, self.starts = None, self.starts + 1
        trouble: str | None = "its process did not start"
        with contextlib.suppress(EOFError, OSError):
            self._outbox.send((self.solver, self.folder))
            if self._inbox.poll(START):
                trouble = self._inbox.recv()
        if trouble is not None:
            self.close()
            raise InputError(trouble, field=f"solvers.{self.solver.name}")

    def _ended(self) -> str:
        """How the process came to its end; it is cleared away."""
        assert self._process is not None
        process = self._process
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(1.0)
        code = process.poll()
        self.close()
        if code is None:
            return "its process closed its pipe"
        return f"killed by signal {-code}" if code < 0 else f"its process ended with status {code}"
