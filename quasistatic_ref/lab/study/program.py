"""What a study asks of a problem: matrices, and the digits of anybody's x."""

from typing import NamedTuple, Protocol

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.numbers.arrays import Array, all_finite
from quasistatic_ref.solve.by_group import coordinate_units
from quasistatic_ref.solve.units import natural_units, out_of_range, sizes_of, squared_lengths
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
        """The program in natural units, which are powers of two: nothing is rounded.

        Raises
        ------
        StepDataError
            If a number leaves the range of float64.
        """
        S, ell, rho = units
        H, g, A, b = self[:4]
        form = StandardForm(H * np.outer(S, S), g * S / rho, A * (S / ell), b / (rho * ell))
        if not all(all_finite(array.ravel()) for array in form):
            raise out_of_range()
        return Program(*form, self.equations)


def units_of(form: StandardForm) -> Units:
    """Natural units of any program; not finite where its numbers are not.

    Raises
    ------
    StepDataError
        As :func:`~quasistatic_ref.certify.norm.energy_norm`.
    """
    coordinate = coordinate_units(np.diag(form.H))
    free_length = energy_norm(form.H).of_impulse(form.g)
    sizes = sizes_of(squared_lengths(form.A, coordinate), form.b, free_length)
    return natural_units(coordinate, sizes)


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
