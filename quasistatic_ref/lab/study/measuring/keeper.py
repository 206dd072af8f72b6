"""The keeper of one solver's process: start, question, kill when it hangs or eats, start again."""

import contextlib
import os
import sys
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from time import perf_counter

import quasistatic_ref
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab import processes
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.measuring.messages import (
    HEAD,
    KEPT,
    READY,
    Response,
    Unreadable,
    from_bytes,
)
from quasistatic_ref.lab.study.store.rows import CRASHED, MEMORY, TIMEOUT
from quasistatic_ref.lab.supervised import Supervised
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

WORKER = "quasistatic_ref.lab.study.measuring.worker"
"""The module that runs in a solver's process."""

START = 120.0
"""Longest that a process may take to import its solver [s]."""

EXTRA = 0.5
"""What a process may take beyond the time limit, for solvers that stop themselves [s]."""

LOOK = 0.02
"""How often the memory of a process is looked at while it computes [s]."""

PINGS = 9
"""Exchanges without a call, whose median is what an exchange takes."""

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS",
     "VECLIB_MAXIMUM_THREADS", "NUMEXPR_NUM_THREADS"), "1",
)  # fmt: skip
"""Each solver has one core, or times could not be compared."""


class Ended(Exception):
    """The process was ended, or ended itself: `outcome`, `words`, and `seconds` until then [s]."""

    def __init__(self, outcome: str, words: str, seconds: float) -> None:
        self.outcome = outcome
        self.words = words
        self.seconds = seconds
        super().__init__(words)


@dataclass(frozen=True)
class Request:
    """Calls that a process makes before it answers.

    Parameters
    ----------
    setting : Setting
    limit : float
        Seconds that each call may take.
    count : int
    g : ndarray, shape (n,), or None
        In place of the program's own, for a call that warms up.
    start : ndarray, shape (n,), or None
        The g of the program whose answer a warm start comes from [N s, N m s].
    mode : str
        What is kept from the step before; empty for a call that keeps nothing.
    first : bool
        Whether a sequence of steps begins.
    """

    setting: Setting
    limit: float
    count: int = 1
    g: Array | None = None
    start: Array | None = None
    mode: str = ""
    first: bool = False


class Keeper:
    """One solver's process, alive from its first question on.

    Parameters
    ----------
    solver : Solver
    folder : str or Path
        Where a callable's module is looked for, in addition to the usual places.
    memory : float
        Most that it may hold, with its children [bytes].
    settings : sequence of Setting
        Whose options it must take; each is tried once, before the first question.
    """

    def __init__(
        self,
        solver: Solver,
        folder: str | Path = ".",
        memory: float = 4e9,
        settings: Sequence[Setting] = (),
    ) -> None:
        self.solver, self.settings = solver, tuple(settings)
        self.folder = str(Path(folder).resolve())
        self.memory = memory
        self._process: Supervised | None = None
        self._sent: deque[StandardForm] = deque(maxlen=KEPT)
        self.starts = 0
        self.exchange = 0.0
        """What an exchange without a call takes [s]."""
        self.seen: set[object] = set()
        """What has been warmed up since the process started."""
        self.modes: tuple[str, ...] = ()
        """In which the solver can be called on sequences, as its process finds them."""

    def answer(self, form: StandardForm, request: Request) -> tuple[Response, float]:
        """What the process says, and the seconds until it did by the clock of this one.

        Without those that either of the two waited for a core, if the system tells, but never
        less than the process was on one.

        Raises
        ------
        Ended
            If it, or an executable, was killed or crashed, or it said what no worker says.
        InputError
            If the solver cannot be imported.
        """
        self.start()
        assert self._process is not None
        calls = request.count * (1 + (request.start is not None))
        patience = calls * request.limit + EXTRA
        message = {**vars(request), "patience": patience, "form": id(form)}
        begin = perf_counter()
        try:
            if not any(form is one for one in self._sent):
                self._outbox.send((id(form), form))
                self._sent.append(form)
            before = processes.computed_and_waited(self._process.pid)
            begin = perf_counter()
            self._outbox.send(message)
            while not self._inbox.poll(LOOK):
                self._watch(perf_counter() - begin, patience, request.limit)
            sizes = len(form.g), len(form.b)
            message_ = self._inbox.recv_bytes(HEAD + 8 * sum(sizes) + 1)
            seconds = perf_counter() - begin
            after = processes.computed_and_waited(self._process.pid)
            computed, waited = (b - a for a, b in zip(before, after, strict=True))
            response = from_bytes(message_, sizes)
        except (EOFError, OSError):
            raise Ended(CRASHED, self._end_in_words(), perf_counter() - begin) from None
        except Unreadable:
            self.close()
            words = "its process wrote what is no reply"
            raise Ended(CRASHED, words, perf_counter() - begin) from None
        if response.crashed:
            raise Ended(CRASHED, response.reply.status, response.times[-1])
        return response, max(seconds - waited, computed)

    def _watch(self, seconds: float, patience: float, limit: float) -> None:
        assert self._process is not None
        if processes.resident(self._process.pid) > self.memory:
            self.close()
            words = f"killed beyond {self.memory / 1e9:g} GB of memory"
            raise Ended(MEMORY, words, seconds)
        if seconds > patience:
            self.close()
            raise Ended(TIMEOUT, f"killed after {limit:g} s", seconds)

    @property
    def pid(self) -> int | None:
        """Of the process, if there is one."""
        return None if self._process is None else self._process.pid

    def tidy(self) -> None:
        """End what has detached itself from the process since it was last tidied."""
        if self._process is not None:
            self._process.tidy()

    def close(self) -> None:
        """End the process, its children, and what they left behind."""
        if self._process is None:
            return
        self._process.end()
        self._inbox.close()
        self._outbox.close()
        self._process = None

    def __enter__(self) -> "Keeper":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def start(self) -> None:
        """Start the process and let it import its solver, if it is not there.

        Raises
        ------
        InputError
            If the solver cannot be imported, or refuses an option.
        """
        if self._process is not None:
            return
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        root = str(Path(quasistatic_ref.__file__).parents[1])
        path = os.pathsep.join([root, *filter(None, [os.environ.get("PYTHONPATH")])])
        words = [sys.executable, "-m", WORKER, str(theirs_in), str(theirs_out)]
        variables = ONE_THREAD | {"PYTHONPATH": path}
        pipes = (theirs_in, theirs_out)  # its own output goes nowhere: solvers print
        self._process = Supervised(words, variables=variables, descriptors=pipes)
        os.close(theirs_in)
        os.close(theirs_out)
        self._inbox = Connection(ours_in, writable=False)
        self._outbox = Connection(ours_out, readable=False)
        self.starts += 1
        self._sent.clear()
        self.seen.clear()
        self.exchange = 0.0
        said = "its process did not start"
        with contextlib.suppress(EOFError, OSError):
            self._outbox.send((self.solver, self.folder, () if self.starts > 1 else self.settings))
            if self._inbox.poll(START):
                said = self._inbox.recv_bytes(HEAD).decode(errors="replace")
        if not said.startswith(READY):
            self.close()
            raise InputError(said, field=f"solvers.{self.solver.name}")
        self.modes = tuple(said.removeprefix(READY).split(","))

    def _end_in_words(self) -> str:
        """How the process came to its end; it is cleared away."""
        assert self._process is not None
        code = self._process.status()
        self.close()
        if code is None:
            return "its process closed its pipe"
        return f"killed by signal {-code}" if code < 0 else f"its process ended with status {code}"


def exchange(keeper: Keeper, form: StandardForm, setting: Setting) -> None:
    """Measure an exchange without a call, once for each process: its median time [s] is kept."""
    if not keeper.exchange:
        nothing = Request(setting, START, 0)
        times = sorted(keeper.answer(form, nothing)[1] for _ in range(PINGS))
        keeper.exchange = times[PINGS // 2]
