"""The process of a solver that is called on sequences: it keeps what the step before left.

Started, watched and ended as :mod:`~quasistatic_ref.lab.study.measuring.worker` is.
"""

import sys
from time import perf_counter
from typing import Any

from quasistatic_ref.lab.study.calling.sessions import Session, modes_of, session_of
from quasistatic_ref.lab.study.measuring.messages import NOTHING, Response
from quasistatic_ref.lab.study.measuring.worker import Answering, serve
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.step.standard_form import StandardForm


def called_in_order(solver: Any, folder: str) -> Answering:
    """A solver that is called step after step; a request for no call gets the solver's modes."""
    modes = ",".join(modes_of(solver.name))
    session: Session | None = None
    before: Reply | None = None

    def answered(form: StandardForm, message: dict[str, Any]) -> Response:
        nonlocal session, before
        if not message["count"]:
            return Response(Reply(None, None, False, modes))
        if message["first"] or session is None:
            setting = message["setting"]
            session, before = session_of(solver.name, setting.name, setting.accuracy), None
        begin = perf_counter()
        try:
            before = session(form, before)
        except Exception as error:  # whatever another package raises
            words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
            before, session = Reply(None, None, False, words), None
        return Response(before or NOTHING, (perf_counter() - begin,))

    return answered


if __name__ == "__main__":
    serve(int(sys.argv[1]), int(sys.argv[2]), called_in_order)
