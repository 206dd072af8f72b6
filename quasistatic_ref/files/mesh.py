"""A mesh: vertices, and triangles between them."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import ModelError
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
