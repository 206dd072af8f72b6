r"""The paper's friction cone: Eqs. :eq:`eq-5`-:eq:`eq-7`, for floats, exact numbers and CVXPY.

Eq. :eq:`eq-4`, phi + [J'(n~ + d~_i)]' delta_q >= 0 for i = 1 to 6, is made of four lengths:

- gap = phi + J_n delta_q, of n~: the distance after the step;
- slip_1 = mu_v J_1 delta_q, of d~_1: the sliding along d1, times its coefficient of friction;
- slip_2 = mu_v J_2 delta_q, of d~_2: that along d2;
- spin = mu_omega J_w delta_q, of d~_5: the rotation about n, times the length mu_omega.

These lines are the only ones in which a step has its rows: the page in CVXPY, the matrix A, the
exact optimum and the forces all follow them.
"""

from typing import Protocol, Self, TypeVar


class Length(Protocol):
    """What can be added and subtracted: numbers, arrays, expressions of CVXPY."""

    def __add__(self, other: Self, /) -> Self:
        """The sum of both lengths."""

    def __sub__(self, other: Self, /) -> Self:
        """Their difference."""


L = TypeVar("L", bound=Length)


def pyramid(gap: L, slip_1: L, slip_2: L, spin: L) -> tuple[L, ...]:
    r"""The six lengths that Eq. :eq:`eq-10` keeps from being negative, in the paper's order.

    With multipliers >= 0 of these rows, the forces on a contact are those of an octahedron,
    :math:`|f_1|/\mu_v + |f_2|/\mu_v + |\tau|/\mu_\omega \le f_n`: the rows share one normal force.
    A contact without torsional friction has the first four.

    Parameters
    ----------
    gap, slip_1, slip_2, spin : float, exact number, array or cvxpy.Expression
        Each contact's lengths [m]; or the rows that lead to them from delta_q.
    """
    return (
        gap + slip_1,  # Eq. (5)
        gap + slip_2,
        gap - slip_1,  # Eq. (6)
        gap - slip_2,
        gap + spin,  # Eq. (7)
        gap - spin,
    )
