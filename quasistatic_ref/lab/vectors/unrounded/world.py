"""Bodies and shapes of a case where they are, in rational numbers: exact, or of the grid."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from quasistatic_ref.lab.program import step as program
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.vectors.distances.shapes import Placed, placed_shape
from quasistatic_ref.lab.vectors.exact.entered import exact_case
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import exact_or_on_grid, working_precision

_settled = np.frompyfunc(exact_or_on_grid, 1, 1)


@dataclass(frozen=True, eq=False)
class World:
    """A case at its configuration.

    Parameters
    ----------
    case : dict
        Input of the layer ``step`` in exact numbers.
    at : dict
        By the name of each body R, t and J as the program has them, in rational numbers.
    """

    case: Json
    at: dict[str | None, Any]

    @property
    def loads(self) -> tuple[Any, Any]:
        """M, and the generalised forces in addition to the stiffness."""
        with working_precision():
            found: tuple[Any, Any] = program.loads(self.case, self.at)
            return found

    def shape(self, name: str) -> Placed:
        """A shape of the case where it is."""
        entry = self.case["shapes"][name]
        with working_precision():
            R, t = (_settled(part) for part in program.pose_in_world(entry, self.at))
            here = {"xyz": [0.0, 0.0, 0.0], "quaternion": [0.0, 0.0, 0.0, 1.0]}
            return replace(placed_shape(entry["shape"], here), R=R, t=t)


def world(case: Json) -> World:
    """A case in the world.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``; numbers that are no float64 are rational.
    """
    case = exact_case(case)
    with working_precision():
        at = kinematics(case["mechanism"], np.array(case["q"]))
        settled = {name: tuple(map(_settled, parts)) for name, parts in at.items()}
    return World(case, settled)
