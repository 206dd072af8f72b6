"""K_q in each form that a user may give it: a matrix, a diagonal, a number, or by name."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.model.named import check_apart
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, checked_array, checked_numbers
from quasistatic_ref.numbers.pivots import positive_definite


def stiffness_matrix(system: System, K_q: ArrayLike | Mapping[str, ArrayLike]) -> Array:
    """The matrix K_q, shape (n_a, n_a) [N/m, N m/rad], symmetric and positive definite.

    Parameters
    ----------
    system : System
    K_q : array_like or mapping
        The matrix; its diagonal, shape (n_a,); one number for all coordinates; or one of these for
        each name of a joint, or of a body, as in ``{"gripper/width": 1000.0}``.

    Raises
    ------
    StepDataError
        If it is none of these, an actuated joint has no stiffness or two names, or the matrix is
        not positive definite.
    """
    if not isinstance(K_q, Mapping):
        return positive_definite("K_q", stiffness_block(K_q, "K_q", system.n_a))
    places = {name: system.named.change(name) for name in K_q}
    check_apart(places, "K_q[{}]", StepDataError)
    matrix = np.zeros((system.n_a, system.n_a))
    for name, block in K_q.items():
        coordinates = places[name]
        if (coordinates >= system.n_a).any():
            raise StepDataError("is not actuated", field=f"K_q[{name}]", value=block)
        part = stiffness_block(block, f"K_q[{name}]", len(coordinates))
        matrix[np.ix_(coordinates, coordinates)] = part
    for coordinate, stiffness in zip(system.coordinates, np.diag(matrix), strict=False):
        if stiffness == 0:
            raise StepDataError(f"has no stiffness for {coordinate.joint}", field="K_q")
    return positive_definite("K_q", matrix)


def stiffness_block(numbers: ArrayLike, name: str, n: int) -> Array:
    """A stiffness matrix (n, n) from a number, a diagonal or a matrix [N/m, N m/rad].

    Raises
    ------
    StepDataError
        About the field `name`, if it is none of these.
    """
    values = checked_numbers(numbers, name)
    if values.ndim == 0:
        return checked_array(values, name, ()) * np.eye(n)
    if values.ndim == 1 and n != 0:
        return np.diag(checked_array(values, name, (n,)))
    return checked_array(values, name, (n, n))
