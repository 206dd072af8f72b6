"""The process in which one solver lives: it may loop, crash or print, and nothing else suffers.

``python -m quasistatic_ref.lab.study.measuring.worker READ WRITE`` is started by
:mod:`~quasistatic_ref.lab.study.measuring.keeper` with two pipes. It receives a solver, then
programs and requests, and sends each reply as it is. It never gets an answer: grading is done elsewhere.
"""

import signal
import subprocess
import sys
from collections import OrderedDict
from collections.abc import Callable
from multiprocessing.connection import Connection
from time import perf_counter
from typing import Any

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.study.calling.calls import Call, Crashed, call_of, on_path
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.lab.study.measuring.messages import NOTHING, Response, to_bytes
from quasistatic_ref.lab.study.measuring.processes import adopt_orphans
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.step.standard_form import StandardForm

Answering = Callable[[StandardForm, dict[str, Any]], Response]
"""(program, request) -> what is sent back."""
KEPT = 2
"""Programs that are kept, as :class:`~.keeper.Keeper` knows."""
GRACE = 2
"""Seconds after which a worker that was forgotten ends itself: its keeper may have been killed."""


def serve(read: int, write: int, opened: Callable[[Any, str], Answering]) -> None:
    """Serve requests until the keeper goes away.

    Parameters
    ----------
    read, write : int
        The pipes.
    opened : callable
        (solver, folder) -> what answers requests; an InputError is sent to the keeper.
    """
    adopt_orphans()
    inbox, outbox = Connection(read, writable=False), Connection(write, readable=False)
    try:
        solver, folder = inbox.recv()
        on_path(folder)
        try:
            answering = opened(solver, folder)
            outbox.send_bytes(b"")
        except QuasistaticError as error:
            outbox.send_bytes(str(error).encode())
            return
        _served(inbox, outbox, answering)
    except (EOFError, BrokenPipeError):
        return  # the keeper is gone


def called_one_by_one(solver: Solver, folder: str) -> Answering:
    """A solver that is called on one problem at a time, and keeps nothing of it."""
    call = call_of(solver, folder)
    return lambda form, message: _answered(form, solver, call, message)


def _served(inbox: Connection, outbox: Connection, answering: Answering) -> None:
    forms: OrderedDict[int, StandardForm] = OrderedDict()
    while True:
        message = inbox.recv()
        if isinstance(message, tuple):
            key, forms[message[0]] = message
            forms.move_to_end(key)
            while len(forms) > KEPT:
                forms.popitem(last=False)
            continue
        form = forms[message["form"]]
        # A looping solver holds the interpreter; this signal's default action ends the process.
        signal.setitimer(signal.ITIMER_REAL, message["patience"] + GRACE)
        response = answering(form, message)
        outbox.send_bytes(to_bytes(response, (len(form.g), len(form.b))))
        signal.setitimer(signal.ITIMER_REAL, 0)


def _answered(form: StandardForm, solver: Solver, call: Call, request: dict[str, Any]) -> Response:
    limit, start = float(request["limit"]), None
    # The matrices stay the same arrays: what is compiled of them is kept, and a start is taken.
    if request["g"] is not None:
        form = StandardForm(form.H, request["g"], form.A, form.b)
    if request["start"] is not None:
        start = StandardForm(form.H, request["start"], form.A, form.b)
    options = solver.settings_of(request["setting"], limit)
    reply, times, begin = NOTHING, [], perf_counter()
    try:
        for _ in range(request["count"]):
            begin = perf_counter()
            reply = call(form, options, start, limit)
            times.append(reply.call_seconds)
    except subprocess.TimeoutExpired:
        late = Reply(None, None, False, f"no answer in {limit:g} s")
        return Response(late, (perf_counter() - begin,), "timeout")
    except Crashed as crash:
        return Response(Reply(None, None, False, str(crash)), (crash.seconds,), "crashed")
    return Response(reply, tuple(times))


if __name__ == "__main__":
    serve(int(sys.argv[1]), int(sys.argv[2]), called_one_by_one)
