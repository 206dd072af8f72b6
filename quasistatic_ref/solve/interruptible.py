"""CVXPY's OSQP and SCS, which hand Ctrl-C on.

Both take the signal for themselves while they solve. CVXPY calls what they answer then a failure of
the solver, as any other, so a run would go on.
"""

from typing import Any

from cvxpy.reductions.solvers.conic_solvers.scs_conif import SCS
from cvxpy.reductions.solvers.qp_solvers.osqp_qpif import OSQP

from quasistatic_ref.solve.solver import check_not_interrupted


class InterruptibleOsqp(OSQP):  # type: ignore[misc]  # CVXPY has no types
    """CVXPY's interface to OSQP under another name, which CVXPY asks of a custom solver."""

    def name(self) -> str:
        """The name under which CVXPY calls this solver."""
        return "INTERRUPTIBLE_OSQP"

    def solve_via_data(self, *data: Any, **options: Any) -> Any:
        """What OSQP answers; KeyboardInterrupt if Ctrl-C ended it."""
        answer = super().solve_via_data(*data, **options)
        check_not_interrupted(answer.info.status)
        return answer


class InterruptibleScs(SCS):  # type: ignore[misc]  # CVXPY has no types
    """CVXPY's interface to SCS under another name, which CVXPY asks of a custom solver."""

    def name(self) -> str:
        """The name under which CVXPY calls this solver."""
        return "INTERRUPTIBLE_SCS"

    def solve_via_data(self, *data: Any, **options: Any) -> Any:
        """What SCS answers; KeyboardInterrupt if Ctrl-C ended it."""
        answer = super().solve_via_data(*data, **options)
        check_not_interrupted(answer["info"]["status"])
        return answer


INTERRUPTIBLE = {"osqp": InterruptibleOsqp(), "scs": InterruptibleScs()}
"""Backends by name, as CVXPY's ``solve`` takes them."""
