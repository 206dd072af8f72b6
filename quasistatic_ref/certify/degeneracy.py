r"""Whether the multipliers are unique and the displacement differentiable, decided exactly.

Let Z be the rows without slack at the optimum x, W in Z a working set with positive multipliers,
and E = Z \ W. Equations are in W, with multipliers of any sign, or follow from those that are.
A row is *strictly active* if its multiplier is positive in some optimal lam.

- The multipliers are unique iff A_Z' c = 0 and c_E >= 0 imply c_E = 0; by Gordan's theorem, iff
  some v has A_W v = 0 and A_E v > 0.
- x is differentiable as a function of g (of tau_a, tau_u and delta_q_bar_a), A and b being fixed,
  iff every row of Z is strictly active: x is then locally the minimiser on A_Z x = b_Z; otherwise
  its directional derivative is the projection on a cone that is no subspace. By Stiemke's theorem
  this holds iff no v has A_W v = 0, A_E v >= 0 and A_E v != 0.

Sticking contacts are differentiable although six rows have rank four. Nothing is said of
derivatives with respect to A and b: where Z has dependent rows, they exist along changes that
keep the dependence (all numbers of one contact), not along those that break it.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, fmpz

from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.active_set import dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import ExactProgram, MatrixProgram, exact_matrix, implied
from quasistatic_ref.step.data import StepData


class Degeneracy(NamedTuple):
    """Whether multipliers are unique and x is differentiable at an optimum.

    Parameters
    ----------
    multipliers_unique : bool
    differentiable : bool
        With respect to g.
    smallest_inactive_slack : float or None
        Smallest slack [m] of the rows that are not strictly active: 0.0 where delta_q is not
        differentiable, otherwise the smallest that is not zero; None if there are no such rows.
    """

    multipliers_unique: bool
    differentiable: bool
    smallest_inactive_slack: float | None


def step_degeneracy(step: StepData, working: Sequence[int]) -> Degeneracy:
    """The degeneracy of the optimum of a step in a polyhedral cone, group by group.

    Parameters
    ----------
    step : StepData
    working : sequence of int
        Independent rows whose multipliers at the optimum are positive, and all others zero.
    """
    parts = group_steps(step)
    return joined_degeneracy(
        form_degeneracy(StepProgram(part), group.within(working)) for group, part in parts
    )


def form_degeneracy(form: ExactProgram, working: Sequence[int]) -> Degeneracy:
    """The degeneracy of a program at the minimiser on a working set."""
    minimiser = Minimiser(form, tuple(working))
    unique, smooth = degeneracy(form, working, minimiser.implied_rows, minimiser.tight_rows)
    return Degeneracy(unique, smooth, minimiser.smallest_slack() if smooth else 0.0)


def joined_degeneracy(every: Iterable[Degeneracy]) -> Degeneracy:
    """The degeneracy of a step, joined from the degeneracies of its groups."""
    unique, smooth, slacks = zip(*every, strict=True)
    return Degeneracy(
        all(unique), all(smooth), min((s for s in slacks if s is not None), default=None)
    )


def degeneracy(
    form: ExactProgram,
    working: Sequence[int],
    implied_rows: Sequence[int],
    tight_rows: Sequence[int],
) -> tuple[bool, bool]:
    """Whether lam is unique, and whether delta_q is differentiable in g.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
        W: independent rows without slack, all multipliers positive but those of equations.
    implied_rows, tight_rows : sequence of int
        E: the other rows without slack, divided into those that W implies and the others.

    Returns
    -------
    (bool, bool)
    """
    if len(tight_rows) <= 1:
        return not implied_rows, not tight_rows
    rows = form.integers(tight_rows)
    total = [sum(column, fmpz(0)) for column in zip(*rows, strict=True)]
    if implied(form.integers(working), [total])[0]:
        # A_E'1 = A_W'c: with lam, lam - t c on W and t on E is optimal for small t > 0.
        return False, True
    # A_E v >= 0 is not zero iff the sum of its entries is positive, and then v can be scaled so
    # that the sum is at least 1.
    smooth = not feasible(form, working, [*rows, total], [0] * len(rows) + [1])
    unique = not implied_rows and feasible(form, working, rows, [1] * len(rows))
    return unique, smooth


def feasible(
    form: ExactProgram,
    working: Sequence[int],
    bounded: Sequence[Sequence[arb | fmpz]],
    least: Sequence[int],
) -> bool:
    """Whether some v has A_W v = 0 and B v >= least, by the active-set method.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
        W.
    bounded : sequence of list of arb or fmpz
        Rows of B, each with a constant, which does not count.
    least : sequence of int
        One for each row.
    """
    n = form.n
    held = form.exact_rows(working)
    sides = zip([*held, *bounded], [*[0] * len(held), *least], strict=True)
    feasibility = MatrixProgram(
        H=exact_matrix(np.eye(n)),
        g=arb_mat(n, 1),
        rows=arb_mat([[*row[:n], arb(-b)] for row, b in sides]),
        equations=len(held),
    )
    return isinstance(dual_active_set(feasibility), Minimiser)
