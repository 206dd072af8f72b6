"""From when to when something held, in steps."""

import numpy as np

from quasistatic_ref.simulate.account import Span
from quasistatic_ref.step.data import Mask
from quasistatic_ref.tolerances import BRIEF


def spans(holds: Mask) -> list[Span]:
    """The spans in which something holds, shape (steps,); a change of `BRIEF` steps is none.

    First what fails to hold that briefly between two spans is bridged, then what holds that briefly
    is left out, unless it goes on at the end or has been there from the start.
    """
    k = np.flatnonzero(holds)
    if not k.size:
        return []
    breaks = np.flatnonzero(np.diff(k) > BRIEF + 1)
    firsts = k[np.concatenate([[0], breaks + 1])].tolist()
    lasts = k[np.concatenate([breaks, [len(k) - 1]])].tolist()
    end = len(holds) - 1
    return [
        Span(first, last)
        for first, last in zip(firsts, lasts, strict=True)
        if last - first >= BRIEF or first == 0 or last == end
    ]
