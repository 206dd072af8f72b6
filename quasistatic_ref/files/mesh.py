"""A mesh: vertices, and triangles between them."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.text import unseen_note
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.tolerances import LARGE


@dataclass(frozen=True, eq=False)
class Mesh:
    """What a mesh file holds, all of its objects where it places them.

    Parameters
    ----------
    vertices : ndarray, shape (V, 3)
        [m].
    triangles : ndarray of int, shape (T, 3)
        Numbers of their vertices; none in a file of points alone.
    note : str
        What a user may not expect of it.

    Raises
    ------
    ModelError
        If a number is none of a vertex, or a coordinate is too large.
    """

    vertices: Array
    triangles: Indices
    note: str = ""

    def __post_init__(self) -> None:
        least, most = self.triangles.min(initial=0), self.triangles.max(initial=-1)
        if least < 0 or most >= len(self.vertices):
            value = int(least if least < 0 else most)
            raise ModelError("must be numbers of vertices", field="triangles", value=value)
        if np.abs(self.vertices[np.isfinite(self.vertices)]).max(initial=0.0) > LARGE:
            raise ModelError(f"must be at most {LARGE:g} m", field="vertices")

    @property
    def corners(self) -> Array:
        """The vertices that a triangle uses, (C, 3) [m]; of points alone, all of them."""
        return self.vertices[np.unique(self.triangles)] if len(self.triangles) else self.vertices

    def seen(self) -> Self:
        """The mesh without vertices that are NaN, as what a camera did not see is.

        Raises
        ------
        ModelError
            Naming the first vertex that is infinite, or NaN and a corner of a triangle.
        """
        is_seen = np.asarray(~np.isnan(self.vertices).any(axis=1))
        bad = np.asarray(np.isinf(self.vertices).any(axis=1))
        bad[self.triangles.ravel()] |= ~is_seen[self.triangles.ravel()]
        if bad.any():
            number = int(bad.argmax())
            problem = "must be finite numbers, or NaN where no face uses it; take it out"
            value = self.vertices[number].tolist()
            raise ModelError(problem, field=f"vertices[{number}]", value=value)
        if is_seen.all():
            return self
        numbers = np.cumsum(is_seen) - 1
        notes = [self.note, unseen_note(int(np.count_nonzero(~is_seen)))]
        note = "; ".join(filter(None, notes))
        vertices = self.vertices[is_seen]
        return replace(self, vertices=vertices, triangles=numbers[self.triangles], note=note)
