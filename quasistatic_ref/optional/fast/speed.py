"""Whether `fast` can be had here, and what is said if it cannot."""

import multiprocessing
import sys
from functools import cache

from quasistatic_ref.optional.fast.compiled.library import why_not
from quasistatic_ref.parts import USABLE


@cache
def usable() -> bool:
    """Whether there is compiled code; if not, one line says so, once, and the plain path runs."""
    reason = why_not()
    if reason is not None and multiprocessing.parent_process() is None:
        print(f"quasistatic-ref: {said(reason)}", file=sys.stderr, flush=True)
    return reason is None


def said(reason: str) -> str:
    """The line for a reason of :func:`~quasistatic_ref.optional.fast.compiled.library.why_not`."""
    extra = 'pip install "quasistatic-ref[fast]"'
    more = "" if extra in reason else f"; {extra} brings a compiler"
    return (
        f"fast needs compiled code: {reason}{more}; the plain path takes the steps, with the same "
        "certified bits, later"
    )


USABLE.fill(usable)
