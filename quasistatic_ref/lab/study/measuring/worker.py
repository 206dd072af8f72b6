"""The process in which one solver lives: it may loop, crash or print, and nothing else suffers.

``python -m quasistatic_ref.lab.study.measuring.worker READ WRITE`` is started by
:mod:`~quasistatic_ref.lab.study.measuring.keeper` with two pipes. It receives a solver, then
programs and requests, and sends each reply as it is. It never gets an answer: grading is done
elsewhere.
"""

import re
import signal
import sys
from collections import OrderedDict
from collections.abc import Sequence
from multiprocessing.connection import Connection
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.lab.processes import adopt_orphans
from quasistatic_ref.lab.study.calling.calls import Crashed, call_of, on_path, reply_or_failure
from quasistatic_ref.lab.study.calling.options import Options
from quasistatic_ref.lab.study.calling.sessions import kept_reply, modes_of
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.measuring.messages import KEPT, NOTHING, READY, Response, to_bytes
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

TINY = StandardForm(np.eye(1), np.ones(1), np.eye(1), np.zeros(1))
"""min 1/2 x^2 - x, x >= 0."""
PATIENCE = 10.0
"""Time limit among the options that are tried on it [s]."""
RAISED = re.compile(r"(?!SolverError: Solver '\w+' failed)\w*(Error|Exception|NotFound)\b")
"""Exceptions that an option causes; CVXPY raises the one left out where a solver itself fails."""
GRACE = 2
"""Seconds after which a worker that was forgotten ends itself: its keeper may have been killed."""


def serve(read: int, write: int) -> None:
    """Serve requests through two pipes, until the keeper goes away."""
    adopt_orphans()
    inbox = Connection(read, writable=False)
    outbox = Connection(write, readable=False)
    try:
        solver, folder, settings = inbox.recv()
        on_path(folder)
        try:
            called = Called(solver, folder)
            called.check_options(settings)
            outbox.send_bytes((READY + ",".join(modes_of(solver))).encode())
        except QuasistaticError as error:
            outbox.send_bytes(str(error).encode())
            return
        _serve(inbox, outbox, called)
    except (EOFError, BrokenPipeError):
        return  # the keeper is gone


class Called:
    """A solver that is called: on one problem at a time, or step after step.

    Parameters
    ----------
    solver : Solver
    folder : str
        Where an executable is looked for and runs.

    Raises
    ------
    InputError
        If the solver cannot be reached.
    """

    def __init__(self, solver: Solver, folder: str) -> None:
        self.solver, self.call = solver, call_of(solver, folder)
        self.before = NOTHING

    def check_options(self, settings: Sequence[Setting]) -> None:
        """Refuse options that the interface does not take, before any problem is put to it.

        Parameters
        ----------
        settings : sequence of Setting

        Raises
        ------
        InputError
            If a call with them raises on a problem that every solver solves.
        """
        for setting in settings:
            options = self.solver.settings_of(setting, PATIENCE)
            if self.solver.known and options:
                said = reply_or_failure(self.call, TINY, options, None).status
                if RAISED.match(said):
                    words = f"refuses options of the setting {setting.name!r}: {said[:120]}"
                    raise InputError(f"{words}; leave them out, or take another interface")

    def response(self, form: StandardForm, request: dict[str, Any]) -> Response:
        """What is sent back.

        Parameters
        ----------
        form : StandardForm
        request : dict
            The fields of a :class:`~.keeper.Request`.
        """
        options = self.solver.settings_of(request["setting"], float(request["limit"]))
        measured = self._next if request["mode"] else self._alone
        try:
            return measured(form, request, options)
        except Crashed as crash:
            reply = Reply(None, None, False, str(crash))
            return Response(reply, (crash.seconds,), crashed=True)

    def _next(self, form: StandardForm, request: dict[str, Any], options: Options) -> Response:
        """The next step of a sequence."""
        before = None if request["first"] else kept_reply(request["mode"], self.before)
        begin = perf_counter()
        self.before = reply_or_failure(self.call, form, options, before)
        return Response(self.before, (perf_counter() - begin,))

    def _alone(self, form: StandardForm, request: dict[str, Any], options: Options) -> Response:
        """One problem, as often as it is asked for."""
        # The matrices stay the same arrays: what is compiled of them is kept, and a start is taken.
        if request["g"] is not None:
            form = form._replace(g=request["g"])
        before = None
        reply = NOTHING
        times = []
        for _ in range(request["count"]):
            if request["start"] is not None:
                start = form._replace(g=request["start"])
                before = reply_or_failure(self.call, start, options, None)
            reply = reply_or_failure(self.call, form, options, before)
            times.append(reply.call_seconds)
        return Response(reply, tuple(times))


def _serve(inbox: Connection, outbox: Connection, called: Called) -> None:
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
        response = called.response(form, message)
        outbox.send_bytes(to_bytes(response, (len(form.g), len(form.b))))
        signal.setitimer(signal.ITIMER_REAL, 0)


if __name__ == "__main__":
    serve(int(sys.argv[1]), int(sys.argv[2]))
