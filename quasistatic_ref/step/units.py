r"""Units in which a step's numbers are expressed.

With :math:`\delta q = \rho\,S\,x` and lengths in units of :math:`\rho\,\ell`, Eqs. :eq:`eq-13` and
:eq:`eq-4` keep their form.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData

FAR: Final = 100.0
"""Distance, in natural units [-], beyond which a contact is as good as infinitely far.

The unconstrained step has a length of about one. Solvers lose digits where 1e6 and 1 stand
together; a row that is put at 100 stays inactive, and the judge, who has the true distance, would
notice if it did not."""


class Units(NamedTuple):
    """Units of one step.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    length : float
        ell [m per (N m s)^0.5].
    size : float
        rho [(N m s)^0.5].
    """

    coordinate: Array
    length: float
    size: float


def si_units(n_v: int) -> Units:
    """SI units for a step of n_v coordinates: all factors are one."""
    return Units(np.ones(n_v), 1.0, 1.0)


def ends_within(step: StepData, units: Units, far: float = FAR) -> tuple[Array, Array]:
    """Gaps of the contacts and ends of the user's rows; those out of reach put nearer.

    They bear nothing, and numbers of very different size cost solvers digits.

    Parameters
    ----------
    step : StepData
    units : Units
    far : float
        How far is out of reach, in these units [-], of rows of at most unit length; of longer ones
        so many times farther.

    Returns
    -------
    phi : ndarray, shape (n_c,)
        In these units [-], as b.
    b : ndarray, shape (e,)
    """
    S, ell, rho = units
    phi = step.contacts.phi / (rho * ell)
    b = step.extra.b / (rho * ell)
    if far < math.inf:
        phi = np.minimum(phi, far * _lengths(step.contacts.J * (S / ell)))
        b = np.maximum(b, -far * _lengths(step.extra.A[:, None] * (S / ell)))
    return phi, b


def _lengths(J: Array) -> Array:
    """The Frobenius norm of each matrix of J, (n, rows, n_v), and at least 1, shape (n,) [-]."""
    return np.asarray(np.maximum(1.0, np.sqrt(np.einsum("cij,cij->c", J, J))))
