"""The frames and Jacobians of contacts: source/rows.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.library import addresses, function

Frames = Callable[[Array, Array, Array, Array], tuple[Array, Array, Array]]


def frames(geometry: ContactGeometry) -> Frames | None:
    """``ContactGeometry.frames`` in C, where each column belongs to one coordinate."""
    if geometry.sums:
        return None
    joint = geometry.joint
    n_c, w = joint.shape
    moves = {name: moved[:, 0] for name, _, moved in geometry.sides}
    sides = [moves.get(name, np.zeros((n_c, w))) for name in ("beta", "alpha")]
    n_x = geometry.n_x
    sizes = np.array([n_c, w, n_x, "beta" in moves, "alpha" in moves])
    kept = addresses((sizes, joint, *sides))
    compiled = function("frames")

    def answer(columns: Array, alpha: Array, beta: Array, n: Array) -> tuple[Array, Array, Array]:
        d1, d2, J = np.empty((n_c, 3)), np.empty((n_c, 3)), np.empty((n_c, 4, w))
        compiled(*kept, *addresses((columns, alpha, beta, n), (d1, d2, J)))
        return d1, d2, J

    return answer


class _Columns(JacobianColumns):
    """Columns of which each is of one coordinate."""

    def of_coordinates(self, columns: Array) -> Array:
        """The same columns, (..., n_x) [m, rad]."""
        return columns


def trials_of_frames() -> list[tuple[ContactGeometry, tuple[Array, ...]]]:
    """Contacts of a body with six columns, of two bodies, and with the world.

    Each array has its shape (k, ...) of the NumPy function.
    """
    moves = np.zeros((3, 1, 8))
    moves[1, 0, 2:] = 1.0
    moves[2, 0, :2] = 1.0
    links = np.array([1, 0, 2, 1]), np.array([0, 1, 1, 2])
    layout = ContactLayout(("c",) * 4, *links, np.ones(4), np.ones(4), np.full(4, 6))
    numbers = np.sin(np.arange(1.0, 90.0))
    columns = numbers[:48].reshape(6, 8)
    alpha, beta = numbers[48:72].reshape(2, 4, 3)
    n = np.array([[0.0, 0.0, 1.0], [0.6, -0.8, 0.0], [-0.36, -0.48, 0.8], [0.48, 0.64, -0.6]])
    geometry = ContactGeometry(layout, _Columns(moves, np.arange(8), 8))
    return [(geometry, (columns, alpha, beta, n))]
