"""K_q in each form that a user may give it: a matrix, a diagonal, a number, or by name."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.model.named import check_apart
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Indices, checked_array, checked_numbers, read_only
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
        return stiffness_of_parts([("K_q", np.arange(system.n_a), K_q)], system.n_a)
    places = {name: system.named.change(name) for name in K_q}
    check_apart(places, "K_q[{}]", StepDataError)
    for name, coordinates in places.items():
        if (coordinates >= system.n_a).any():
            problem = "is not actuated; leave it out, or actuate it"
            raise StepDataError(problem, field=f"K_q[{name}]", value=K_q[name])
    parts = [(f"K_q[{name}]", places[name], numbers) for name, numbers in K_q.items()]
    matrix = stiffness_of_parts(parts, system.n_a)
    for coordinate, stiffness in zip(system.coordinates, np.diag(matrix), strict=False):
        if stiffness == 0:
            raise StepDataError(f"has no stiffness for {coordinate.joint}; add it", field="K_q")
    return matrix


def stiffness_of_parts(parts: Iterable[tuple[str, Indices, ArrayLike]], n: int) -> Array:
    """A stiffness matrix, shape (n, n) [N/m, N m/rad], whose parts nothing couples.

    Parameters
    ----------
    parts : iterable of tuple
        Of each its field in messages, its coordinates, and a number, a diagonal or a matrix.
    n : int

    Raises
    ------
    StepDataError
        Naming the field that is none of these, or not positive definite.
    """
    matrix = np.zeros((n, n))
    for name, coordinates, numbers in parts:
        block = positive_definite(name, _block(numbers, name, len(coordinates)))
        matrix[np.ix_(coordinates, coordinates)] = block
    return read_only(matrix)


def _block(numbers: ArrayLike, name: str, n: int) -> Array:
    """A matrix (n, n) from a number, a diagonal or a matrix [N/m, N m/rad]."""
    values = checked_numbers(numbers, name)
    if values.ndim == 0:
        return checked_array(values, name, ()) * np.eye(n)
    if values.ndim == 1 and n != 0:
        return np.diag(checked_array(values, name, (n,)))
    return checked_array(values, name, (n, n))
