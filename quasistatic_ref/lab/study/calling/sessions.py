"""What a solver can keep from one step of a sequence to the next.

A simulation solves problems whose g, A and b all change a little; what a solver can keep of the
last one differs: its point, its point and multipliers, its active set, or its memory and factors
only. Which of these a solver takes is a fact of its interface.
"""

from dataclasses import replace

from quasistatic_ref.lab.study.calling.calls import function_of, takes_start
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.solve.reply import Reply

COLD = "cold"
UPDATES = "updates"
MODES = (COLD, UPDATES, "primal", "primal-dual", "active set")
"""Set up again each time; or from what was left: memory and factors alone, the point, the point
with its multipliers, the active set."""


def modes_of(solver: Solver) -> tuple[str, ...]:
    """The modes in which a solver can be called; a callable is imported to know.

    Parameters
    ----------
    solver : Solver
        A callable may take ``start=(x, z)``.

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    if solver.interface in ("package", "callable"):
        return (COLD, "primal-dual") if takes_start(function_of(solver)) else (COLD,)
    if solver.interface == "qpsolvers" and solver.warm:
        return (COLD, "primal")
    return (COLD,)


def kept_reply(mode: str, before: Reply) -> Reply | None:
    """What a mode keeps of the reply to the step before; None if it keeps nothing.

    A step that was not solved starts nothing: what its solver left may be no point at all (OSQP's
    x of an infeasible step has entries of 2147483647), and the next is set up again.
    """
    if mode == COLD or not before.solved:
        return None
    return replace(before, x=None, lam=None) if mode == UPDATES else before
