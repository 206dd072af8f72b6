"""Bodies and shapes of a case where they are, in rational numbers: exact, or of the grid."""

from dataclasses import dataclass, replace
from functools import cached_property

from quasistatic_ref.lab.vectors.distances.shapes import Placed, placed
from quasistatic_ref.lab.vectors.exact.algebra import Matrix, Vector, moved, product
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, Poses, mechanism, poses
from quasistatic_ref.lab.vectors.exact.precision import numbers
from quasistatic_ref.lab.vectors.exact.rotation import rotation
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.step import loads_of
from quasistatic_ref.lab.vectors.whole.grid import exact_or_on_grid, working


@dataclass(frozen=True, eq=False)
class World:
    """A case at its configuration.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``; its numbers are float64 or exact.
    tree : Mechanism
    at : Poses
        Of every body, in rational numbers.
    known : (matrix, vector), optional
        Its loads, where they are those of another case.
    """

    case: Json
    tree: Mechanism
    at: Poses
    known: tuple[Matrix, Vector] | None = None

    @cached_property
    def loads(self) -> tuple[Matrix, Vector]:
        """M_u, and the generalised forces in addition to the stiffness."""
        if self.known:
            return self.known
        with working():
            return loads_of(self.tree, self.at, self.case)

    def with_case(self, case: Json) -> "World":
        """Another case at the same configuration, with what it has in common with this one."""
        if case["mechanism"] is self.case["mechanism"]:
            return World(case, self.tree, self.at, self.loads)
        return World(case, mechanism(case["mechanism"]), self.at)

    def shape(self, name: str) -> Placed:
        """A shape of the case where it is."""
        entry = self.case["shapes"][name]
        with working():
            R, t = rotation(numbers(entry["pose"]["quaternion"])), numbers(entry["pose"]["xyz"])
            body = self.tree.number(entry["body"])
            if body is not None:
                R, t = product(self.at.R[body], R), moved(self.at.R[body], self.at.t[body], t)
            here = {"xyz": [0.0, 0.0, 0.0], "quaternion": [0.0, 0.0, 0.0, 1.0]}
            return replace(placed(entry["shape"], here), R=_matrix(R), t=_vector(t))


def world(case: Json) -> World:
    """A case in the world.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``; numbers that are no float64 are rational.
    """
    tree = mechanism(case["mechanism"])
    with working():
        at = poses(tree, case["q"])
        columns = [
            {v: (_vector(nu), _vector(w)) for v, (nu, w) in body.items()} for body in at.columns
        ]
        found = Poses([_matrix(R) for R in at.R], [_vector(t) for t in at.t], columns)
    return World(case, tree, found)


def _vector(x: Vector) -> Vector:
    return [exact_or_on_grid(v) for v in x]


def _matrix(A: Matrix) -> Matrix:
    return [_vector(row) for row in A]
