"""DAQP's own call on a program, from cold: what a step is compared with."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import daqp
import numpy as np

from quasistatic_ref.solve.adapters.program import Program
from quasistatic_ref.tolerances import ACCURACY


def bare_daqp(program: Program) -> Callable[[], Any]:
    """``daqp.solve`` with nothing around it, of the program as it stands at the time of the call.

    Parameters
    ----------
    program : Program
    """
    m = len(program.b)
    unbounded, sense = np.full(m, np.inf), np.zeros(m, dtype=np.int32)
    given = (program.H, program.f, program.A, unbounded, program.b, sense)
    return partial(daqp.solve, *given, primal_tol=ACCURACY, dual_tol=ACCURACY)
