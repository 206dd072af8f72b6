"""What every adapter is given, and what it gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from quasistatic_ref.step.data import Array


@dataclass(frozen=True, eq=False)
class Program:
    """min 1/2 x'Hx + f'x subject to A x >= b: arrays that are written anew at each step.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
    f : ndarray, shape (n_v,)
        -g of :class:`~quasistatic_ref.step.standard_form.StandardForm` [N m s].
    A : ndarray, shape (m, n_v)
        In the memory order that the adapter asks for.
    b : ndarray, shape (m,)
    """

    H: Array
    f: Array
    A: Array
    b: Array


@dataclass(eq=False)
class Reply:
    """What a solver said.

    Parameters
    ----------
    x : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)
        Multipliers of A x >= b, >= 0 but for the solver's tolerance.
    solved : bool
        Whether it claims a full solution.
    status : str
        Its own word.
    iterations : int or None
    seconds : float or None
        Inside the solver [s], where it says so.
    """

    x: Array
    lam: Array
    solved: bool
    status: str
    iterations: int | None
    seconds: float | None


class Adapter(Protocol):
    """A solver that holds one program.

    Attributes
    ----------
    ORDER : str
        ``"C"`` or ``"F"``: the memory order in which it takes A and H.
    WARM : bool
        Whether its start from the answer before differs from a cold one.
    NEAR : bool
        Whether it loses digits on gaps of 1e6 beside numbers of size one. An active-set method
        does not: rows that are far are never in its set.
    """

    ORDER: str
    WARM: bool
    NEAR: bool

    def __init__(self, program: Program, options: dict[str, Any]) -> None:
        """Set up with the program as it stands."""

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands now, from the answer before if `warm`."""
