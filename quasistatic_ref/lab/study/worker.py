"""The process in which one solver lives: it may loop, crash or print, and nothing else suffers.

``python -m quasistatic_ref.lab.study.worker READ WRITE`` is started by
:mod:`~quasistatic_ref.lab.study.keeper` with two pipes. It receives a solver, then problems and
requests, and sends the graded reply to each request.
"""

import signal
import subprocess
import sys
import time
from multiprocessing.connection import Connection
from typing import Any

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.study.calls import Call, Crashed, call_of, neighbour, on_path
from quasistatic_ref.lab.study.grade import CRASHED, TIMEOUT, Exam, exam, grades, ungraded
from quasistatic_ref.lab.study.qp import Problem
from quasistatic_ref.lab.study.solvers import Setting, Solver

GRACE = 2
"""Seconds after which a worker that was forgotten ends itself: its keeper may have been killed."""


def main(read: int, write: int) -> None:
    """Serve requests until the keeper goes away."""
    inbox, outbox = Connection(read, writable=False), Connection(write, readable=False)
    try:
        solver, folder = inbox.recv()
        on_path(folder)
        try:
            call = call_of(solver, folder)
            outbox.send(None)
        except QuasistaticError as error:
            outbox.send(str(error))
            return
        _serve(inbox, outbox, solver, call)
    except (EOFError, BrokenPipeError):
        return  # the keeper is gone


def _serve(inbox: Connection, outbox: Connection, solver: Solver, call: Call) -> None:
    problem: Problem | None = None
    paper: Exam | None = None
    while True:
        message = inbox.recv()
        if isinstance(message, Problem):
            problem, paper = message, exam(message)
            continue
        assert problem is not None  # the keeper sends it first
        assert paper is not None
        # A looping solver holds the interpreter; this signal's default action ends the process.
        signal.setitimer(signal.ITIMER_REAL, (1 + message["warm"]) * message["limit"] + GRACE)
        outbox.send(_answered(problem, paper, solver, call, message))
        signal.setitimer(signal.ITIMER_REAL, 0)


def _answered(
    problem: Problem, paper: Exam, solver: Solver, call: Call, request: dict[str, Any]
) -> dict[str, Any]:
    setting: Setting = request["setting"]
    form, limit = paper.forms[request["units"]], float(request["limit"])
    options = solver.settings_of(setting, limit)
    start = neighbour(form, problem.id) if request["warm"] else None
    begin = time.perf_counter()
    try:
        reply = call(form, options, start, limit)
    except subprocess.TimeoutExpired:
        return ungraded(TIMEOUT, f"no answer in {limit:g} s", time.perf_counter() - begin)
    except Crashed as crash:
        return ungraded(CRASHED, str(crash), crash.seconds)
    return grades(paper, request["units"], reply, setting.promised)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
