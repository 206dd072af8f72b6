r"""The ellipsoid where it is rational: every contact that bears load sticks, at the cone's apex.

There A_j x = b_j holds for all rows of those contacts: x is the minimiser on independent ones
among them, a solution of linear equations. The rows of all these contacts may be dependent, so lam
is not unique; given one in float64, changes of its entries on the independent rows alone make

.. math:: H x - g = A^T \lambda

exact. Whether x and the changed lam are inside of their cones, and lam'(A x - b) = 0, is then
decided in rational numbers: by convexity nothing else has to be checked.
"""

from collections.abc import Sequence
from typing import NamedTuple

from flint import fmpq, fmpq_mat

from quasistatic_ref.exact.program import EXACT, ExactProgram, fraction, independent_rows
from quasistatic_ref.exact.working_set import KktPoint, fraction_point
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.impulses import ONE, cone_blocks, inside, outside_of_cones
from quasistatic_ref.optional.gap import fractions, rational
from quasistatic_ref.step.data import StepData


class Apex(NamedTuple):
    """The minimiser where every contact that bears load sticks, and whether it is the optimum.

    Parameters
    ----------
    rows : tuple of int
        The first independent rows among all rows of the contacts that bear load, in increasing
        order. Directions without friction are left out: they bear nothing.
    solution : Point
        The minimiser on them.
    refutation : str
        Why it is not the optimum of the step; empty if it is.
    """

    rows: tuple[int, ...]
    solution: KktPoint
    refutation: str


def apex(step: StepData, form: ExactProgram, lam: Array) -> Apex:
    """The minimiser at the apexes of the contacts that bear load.

    Parameters
    ----------
    step : StepData
    form : ExactProgram
        That of the step.
    lam : ndarray, shape (m,)
        Impulses; those of the rows need to be right but for rounding.
    """
    rows = independent_rows(form, [
        i
        for _, block, c in cone_blocks(step)
        if lam[block[0]] > 0
        for i, mu in zip(block, [ONE, *c], strict=True)
        if mu > 0
    ])  # fmt: skip
    solution = fraction_point(form, rows)
    return Apex(rows, solution, _refutation(step, form, rows, solution, lam))


def _refutation(
    step: StepData, form: ExactProgram, rows: Sequence[int], solution: KktPoint, lam: Array
) -> str:
    """Why a solution is not the optimum; empty if it is."""
    with working_precision(EXACT):
        slack = solution.in_fractions(form.slacks(range(form.m), solution.z))
    pull = solution.in_fractions(solution.net.entries())
    impulse = _balanced(form, rows, fractions(lam), [v / fraction(form.h) for v in pull])
    for name, block, c in cone_blocks(step):
        if not inside(slack[block[0]], [m * slack[i] for m, i in zip(c, block[1:], strict=True)]):
            return f"{name} is violated by the minimiser on the working set"
    if name := outside_of_cones(step, impulse):
        return f"the force at {name} is outside of its cone"
    work = sum((s * f for s, f in zip(slack, impulse, strict=True)), fmpq(0))
    return "a contact that is open bears load" if work else ""


def _balanced(
    form: ExactProgram, working: Sequence[int], lam: list[fmpq], net: list[fmpq]
) -> list[fmpq]:
    """Lam changed on the working rows, so that A'lam = net if it is inside of its cones.

    What else bears load, off the span of these rows, does so where there is no normal force or no
    friction: outside of its cone.
    """
    if not working:
        return lam
    A = rational(form.A)
    short = fmpq_mat(form.n, 1, net) - A.transpose() * fmpq_mat(form.m, 1, lam)
    table = A.tolist()
    W = fmpq_mat([table[i] for i in working])
    change = (W * W.transpose()).solve(W * short)
    changed = list(lam)
    for i, d in zip(working, change.entries(), strict=True):
        changed[i] += d
    return changed
