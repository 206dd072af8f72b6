"""What a user adds to a step: constraints and costs, written in SI units with CVXPY.

CVXPY itself is not needed to say what an extension is;
:mod:`~quasistatic_ref.optional.extensions.extended` builds its symbols and solves with it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import cvxpy as cp


Own = Callable[[Any], Sequence[Any]]
"""Constraints or scalar costs of a user's own, as a function of the symbols that they are about."""


def none(symbols: Any) -> tuple[()]:
    """No constraints or costs of a user's own."""
    return ()


@dataclass(frozen=True, eq=False)
class Symbols:
    """What an extension may use: CVXPY expressions in SI units, whatever units the problem has.

    Parameters
    ----------
    delta_q, delta_q_a, delta_q_u : cvxpy.Expression
        The unknowns [m, rad].
    delta_q_bar_a : cvxpy.Expression
        Desired change of the actuated coordinates [m, rad].
    slack : tuple of cvxpy.Expression
        One expression for each row index i of the cone: phi + [J'(n~ + d~_i)]' delta_q [m] of the
        contacts that have row i. In the ellipsoid, the gap phi + J_n delta_q alone.
    """

    delta_q: cp.Expression
    delta_q_a: cp.Expression
    delta_q_u: cp.Expression
    delta_q_bar_a: cp.Expression
    slack: tuple[cp.Expression, ...]


@dataclass(frozen=True, eq=False)
class Extension:
    """Constraints and costs of a user's own.

    Parameters
    ----------
    terms : callable
        Symbols -> constraints and scalar costs, in any order. A cost is added to (13), whose unit
        is h times an energy [N m s]; parameters and further variables are the user's own.
    without_stiffness : bool
        Whether the costs take the place of the impedance (1): K_q and tau_k are then zero.
    """

    terms: Callable[[Symbols], Sequence[cp.Constraint | cp.Expression]]
    without_stiffness: bool = False
