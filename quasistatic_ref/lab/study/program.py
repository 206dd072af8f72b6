"""What a study asks of a problem: matrices, and the digits of anybody's x."""

from typing import NamedTuple, Protocol

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.units import natural_form
from quasistatic_ref.step.standard_form import StandardForm, Units


class Program(NamedTuple):
    """min 1/2 x'Hx - g'x subject to A x >= b, whose first rows may be equations.

    Parameters
    ----------
    H : ndarray, shape (n, n)
        Positive definite.
    g : ndarray, shape (n,)
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)
    equations : int
        How many of the first rows hold with equality.
    """

    H: Array
    g: Array
    A: Array
    b: Array
    equations: int = 0

    def natural(self, units: Units) -> "Program":
        """The program in natural units, which are powers of two: nothing is rounded."""
        form = natural_form(StandardForm(*self[:4]), units)
        return Program(*form, self.equations)


class Known(Protocol):
    """A problem whose exact answer is known, or that is proved to have none.

    Those of contact-qp are one kind. A study needs nothing else of a problem, but that it can be
    pickled where an executor is used.
    """

    @property
    def id(self) -> str:
        """The program's name, unique in a study."""

    @property
    def family(self) -> str:
        """The name of the program's family, a row of the table by families."""

    @property
    def dial(self) -> float | None:
        """The value of the family's dial; None if the family has no dial."""

    @property
    def feasible(self) -> bool:
        """Whether the program has a solution."""

    @property
    def program(self) -> Program:
        """The matrices of the problem, as they are given."""

    @property
    def units(self) -> Units:
        """The problem's natural units; ``units_of(form)`` finds some for any matrices."""

    def digits(self, x: Array) -> float:
        """Correct digits of an x, shape (n,), as the problem is given [-]; if it has a solution."""
