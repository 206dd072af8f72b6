"""J of Eq. :eq:`eq-3` without its zeros, for steps of many bodies."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.step.arrays import Array, Indices, check_and_freeze


@dataclass(frozen=True, eq=False)
class Blocks(Plain):
    """Of each contact, the columns of the coordinates that move one of its two bodies.

    Parameters
    ----------
    column : ndarray of int, shape (n_c, w)
        Which columns, ascending; n_v, one beyond the last, where a contact has fewer than w. A
        read-only array is kept and not copied: two steps that share it have their entries in the
        same places, and one sees so without comparing numbers.
    J : ndarray, shape (n_c, 4, w)
        Those columns of the J of ``Contacts``; zero where a contact has fewer than w.
    n_v : int
        Number of coordinates.

    Raises
    ------
    StepDataError
        If a shape is wrong, columns do not ascend, or a number is not finite.
    """

    column: Indices
    J: Array
    n_v: int

    def __post_init__(self) -> None:
        column = np.asarray(self.column)
        if column.ndim != 2 or column.dtype.kind != "i":
            problem = "must contain whole numbers, w for each contact"
            raise StepDataError(problem, field="blocks.column", value=column.shape)
        rises = (np.diff(column) > 0) | (column[:, 1:] == self.n_v)
        if not rises.all() or column.min(initial=0) < 0 or column.max(initial=0) > self.n_v:
            problem = f"must ascend in each row, from 0 to n_v = {self.n_v}, which alone repeats"
            raise StepDataError(problem, field="blocks.column", value=column.tolist())
        if column.flags.writeable:
            column = column.astype(np.int64)
            column.setflags(write=False)
            object.__setattr__(self, "column", column)
        check_and_freeze(self, {"J": (len(column), 4, column.shape[1])}, "blocks.")

    def dense(self) -> Array:
        """All columns, shape (n_c, 4, n_v)."""
        return self.columns(np.arange(len(self.column)), np.arange(self.n_v))

    def columns(self, contacts: Indices, coordinates: Indices) -> Array:
        """J of some contacts, shape (k, 4, n), in ascending coordinates that alone move them."""
        place = np.searchsorted(coordinates, self.column[contacts])
        known = np.append(coordinates, self.n_v)
        place[known[place] != self.column[contacts]] = len(coordinates)  # columns of zeros
        wide = np.zeros((len(contacts), 4, len(coordinates) + 1))
        J = self.J[contacts]
        np.put_along_axis(wide, np.broadcast_to(place[:, None], J.shape), J, axis=2)
        return np.ascontiguousarray(wide[:, :, :-1])

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        own = np.append(delta_q, 0.0)[self.column]
        return np.asarray((self.J @ own[:, :, None])[:, :, 0])
