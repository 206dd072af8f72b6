"""The process of a solver that is asked sequences: it keeps what the step before left.

Started, watched and ended as :mod:`~quasistatic_ref.lab.study.worker` is.
"""

import sys
from time import perf_counter
from typing import Any

from quasistatic_ref.lab.study.sessions import Session, modes_of, session_of
from quasistatic_ref.lab.study.wire import NOTHING, Told
from quasistatic_ref.lab.study.worker import Answering, serve
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.step.standard_form import StandardForm


def asked_in_order(solver: Any, folder: str) -> Answering:
    """A solver that is asked step after step; a request for no call is told its modes."""
    modes = ",".join(modes_of(solver.name))
    session: Session | None = None
    before: Reply | None = None

    def answered(form: StandardForm, message: dict[str, Any]) -> Told:
        nonlocal session, before
        if not message["count"]:
            return Told(Reply(None, None, False, modes))
        if message["first"] or session is None:
            setting = message["setting"]
            session, before = session_of(solver.name, setting.name, setting.accuracy), None
        begin = perf_counter()
        try:
            before = session(form, before)
        except Exception as error:  # whatever another package raises
            words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
            before, session = Reply(None, None, False, words), None
        return Told(before or NOTHING, (perf_counter() - begin,))

    return answered


if __name__ == "__main__":
    serve(int(sys.argv[1]), int(sys.argv[2]), asked_in_order)
