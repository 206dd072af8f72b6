r"""Zeros of the minimiser on a working set: slacks of other rows, and coordinates.

No ball shows that a number is zero, and no float64 does. Most zeros follow from the working set's
equations alone. Others are due to what does not act: a ball that spins under its own weight does
not slide, because nothing pushes it along. Those are read from the rational solution.

With zeros of the second kind a row e without slack may be one that W does not span. Then whether
the multipliers are unique and delta_q is differentiable depends on which combinations of such rows
W spans (:mod:`~quasistatic_ref.certify.degeneracy`). If it spans their sum, as it does where both
directions of a slip are closed, they all are strictly active, and lam is not unique.
"""

from collections.abc import Sequence

from flint import fmpz

from quasistatic_ref.certify.dependence import all_follow, spanned_in_contacts
from quasistatic_ref.certify.kkt import rational_solution
from quasistatic_ref.certify.rational import exact_form, exact_rows
from quasistatic_ref.step.data import StepData


def zeros_hold(
    step: StepData, working: Sequence[int], rows: Sequence[int], coordinates: Sequence[int]
) -> bool:
    """Whether some slacks and x are zero, all of them, and W spans the sum of the rows.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    working : sequence of int
        W: independent rows.
    rows, coordinates : sequence of int

    Returns
    -------
    bool
        If it is true all rows without slack are strictly active, and the multipliers are unique
        only where there are no `rows`. If it is false nothing is known.
    """
    if not coordinates and spanned_in_contacts(step, working, rows):
        return True
    n, k = step.n_v, len(working)
    exact = exact_rows(step, [*working, *rows])
    zeros = [[fmpz(int(i == v)) for i in range(n + 1)] for v in coordinates]
    if all_follow(exact[:k], [*exact[k:], *zeros]):
        return True
    form = exact_form(step, [*working, *rows])
    solution = rational_solution(form, tuple(range(k)))
    if any(solution.slack[k:]) or any(solution.x[v] for v in coordinates):
        return False
    total = [sum(column) for column in zip(*exact[k:], strict=True)]
    return not rows or all_follow(exact[:k], [total])
