"""A quadratic program of float64 numbers without rounding, and the slacks of its rows."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.certify.form import ExactForm, MatrixForm, exact_matrix
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.pivots import exact_factor


def exact_form_of(H: Array, g: Array, A: Array, b: Array) -> MatrixForm:
    """H, g, A, b taken as they are given.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
        Symmetric to the last bit.
    g : ndarray, shape (n_v,)
    A : ndarray, shape (m, n_v)
    b : ndarray, shape (m,)

    Returns
    -------
    MatrixForm

    Raises
    ------
    StepDataError
        If H is not symmetric and positive definite, or a number is not finite.
    InputError
        If nothing can be proved in this thread.
    """
    check_arithmetic()
    for name, array in (("H", H), ("g", g), ("A", A), ("b", b)):
        if not np.isfinite(array).all():
            raise StepDataError("must contain finite numbers only", field=name, value=array)
    if not np.array_equal(H, H.T):
        raise StepDataError("must be symmetric to the last bit", field="H", value=H.tolist())
    if exact_factor(H, 0.0) is None:
        raise StepDataError("must be positive definite without rounding", field="H")
    column = np.asarray(g, dtype=np.float64)[:, None]
    return MatrixForm(*map(exact_matrix, (H, column, np.column_stack([A, -b]))))


def exact_slack(form: ExactForm, working_set: Sequence[int]) -> Array:
    """A x - b at the minimiser on a working set, each entry rounded correctly, shape (m,) [m].

    Parameters
    ----------
    form : ExactForm
    working_set : sequence of int
        Independent rows.
    """
    minimiser = Minimiser(form, tuple(working_set))
    inactive = minimiser.inactive
    slack = np.zeros(form.m)
    slack[inactive] = minimiser.rounded(lambda m: form.slacks(inactive.tolist(), m.z))
    return slack
