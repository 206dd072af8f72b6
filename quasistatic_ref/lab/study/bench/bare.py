"""DAQP's own call on a program, from cold: what a step is compared with."""

from __future__ import annotations

from typing import Any

import daqp
import numpy as np

from quasistatic_ref.solve.adapters.program import Program
from quasistatic_ref.tolerances import ACCURACY


class BareDaqp:
    """One call a time, with nothing around it.

    Parameters
    ----------
    program : Program
        Solved as it stands at the time of the call.
    """

    def __init__(self, program: Program) -> None:
        m = len(program.b)
        unbounded, sense = np.full(m, np.inf), np.zeros(m, dtype=np.int32)
        self._given = (program.H, program.f, program.A, unbounded, program.b, sense)

    def __call__(self) -> Any:
        """What ``daqp.solve`` returns."""
        return daqp.solve(*self._given, primal_tol=ACCURACY, dual_tol=ACCURACY)
