"""What un-actuated coordinates move together, and what is missing for its equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.exact.components import connected_components
from quasistatic_ref.simulate.standing import Standing

if TYPE_CHECKING:
    from quasistatic_ref.model.state import State
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.step.data import StepData

COUNTS = 0.1
"""Part of the first kinetic energy [-] from which on a force, or a torque, is said."""
REACTION = 1e-3
"""Part of the first power of a body that a joint has which stays [-]: its force is a reaction."""
FARTHEST = 1.0
"""Size that stands for that of a body without shapes, or of a half-space [m]."""


@dataclass(frozen=True, eq=False)
class Body:
    """What un-actuated coordinates move together.

    Parameters
    ----------
    name : str
        Of a free body; else of a body's first joint.
    coordinates : ndarray of int
        Entries of delta_q.
    lengths : ndarray of bool
        Which of these are lengths.
    free : bool
        Whether it is one floating base alone.
    R : ndarray, shape (3, 3)
        Of the first link that they move, to the world.
    mass : float
        Of the links that they move [kg].
    size : float
        Of its largest shape in a pair [m].
    """

    name: str
    coordinates: Indices
    lengths: Mask
    free: bool
    R: Array
    mass: float
    size: float

    def missing(self, starts: Array, M: Array) -> Standing:
        """What is missing where a body would start to move: M starts.

        Parameters
        ----------
        starts : ndarray, shape (n,)
            Its acceleration, turned round [m/s^2, rad/s^2].
        M : ndarray, shape (n, n)
            Its inertia [kg, kg m, kg m^2].
        """
        r = M @ starts
        power = np.abs(r * starts)
        if not self.free:
            r = np.where(power > REACTION * power.sum(), r, 0.0)
        force, torque = r[self.lengths], r[~self.lengths]
        if self.free:
            torque = torque - M[3:, :3] / M[0, 0] @ force  # about the centre of mass
        turning = torque @ starts[~self.lengths] / (r @ starts)
        slides, turns = turning < 1 - COUNTS, turning > COUNTS
        along = self.R @ (force if slides else torque) if self.free else r
        return Standing(
            self.name,
            False,
            float(np.linalg.norm(force) * slides),
            float(np.linalg.norm(torque) * turns),
            tuple((along / np.linalg.norm(along)).tolist()),
        )


def bodies_of(scene: Simulator, step: StepData, here: State) -> tuple[list[Body], Indices]:
    """What moves together in a step, and the first coordinate of each coordinate's body, (n_v,).

    Coordinates of one joint do, and those that an entry of M_u couples.

    Parameters
    ----------
    scene : Simulator
    step : StepData
    here : State
        Where it is.
    """
    system = scene.system
    first = np.arange(step.n_v)
    for joint in system.joints:
        first[joint.v] = joint.v.start
    i, j = step.hessian.entries
    of = np.append(i, first), np.append(j, np.arange(step.n_v))
    label, _ = connected_components(*of, (step.n_v, step.n_v))
    column_map = system.column_map
    moves = column_map.of_coordinates(column_map.moves)[:, 0] != 0
    sides = [side for pair in scene.pairs for side in (pair.alpha, pair.beta)]
    of_sides = np.array([side.link for side in sides], dtype=np.int64)
    extents = np.array([side.shape.extent for side in sides])
    lengths = np.array([coordinate.unit == "m" for coordinate in system.coordinates])
    bodies = []
    for joint in system.joints:
        if joint.actuated or label[joint.v.start] != joint.v.start:
            continue
        at = np.flatnonzero(label == joint.v.start)
        links = np.flatnonzero(moves[:, at].any(axis=1))
        own = np.isin(of_sides, links) & (extents < np.inf)
        bodies.append(
            Body(
                name=joint.name.removesuffix("/base"),
                coordinates=at,
                lengths=lengths[at],
                free=joint.free and len(at) == 6,
                R=here.kinematics.R[links[0]],
                mass=float(system.masses[links].sum()) or 1.0,
                size=float(extents[own].max(initial=0.0)) or FARTHEST,
            )
        )
    return bodies, label
