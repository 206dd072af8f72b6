"""What un-actuated coordinates move together, and what is missing for its equilibrium."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import connected_components
from quasistatic_ref.text.quoting import listed

if TYPE_CHECKING:
    from quasistatic_ref.model.joints.joint import Joint
    from quasistatic_ref.model.system import System
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.simulate.scene import Scene
    from quasistatic_ref.simulate.simulator import Simulator

COUNTS = 0.1
"""Part of an amount from which on it is said [-]."""
NOTHING = 1e-4
"""Part of the first kinetic energy [-] that is none: a torque of a hundredth of the force times the
radius of gyration, which is how right r is."""
REACTION = 1e-3
"""Part of the first power of a body that a joint has which stays [-]."""
FARTHEST = 1.0
"""Size that stands for that of a body without shapes, or of a half-space [m]."""


class Missing(NamedTuple):
    """What a body lacks for equilibrium.

    Parameters
    ----------
    amount : float
        Its mass times the root mean square of its points' first acceleration [N]: of no frame, and
        for comparing alone.
    force, torque : float
        Of a free body about its centre of mass; else along its joints that slide and that turn
        [N, N m].
    r : ndarray
        What would have to be added, along its coordinates [N, N m].
    turning : float
        Part of its first kinetic energy that is in turning [-].
    """

    amount: float
    force: float
    torque: float
    r: Array
    turning: float

    def __str__(self) -> str:
        parts = []
        if self.turning < 1 - COUNTS:
            parts.append(f"{self.force:.3g} N")
        if self.turning > COUNTS:
            parts.append(f"{self.torque:.3g} N m")
        return " and ".join(parts)


@dataclass(frozen=True, eq=False)
class Body:
    """A body, or joints, that un-actuated coordinates move together.

    Parameters
    ----------
    name : str
        Of a free body; else of a body's first joint.
    coordinates : ndarray of int
        Entries of delta_q.
    free : bool
        Whether it is one floating base alone.
    mass : float
        Of the links that they move [kg].
    links : ndarray of bool, shape (L,)
        Those.
    contacts : ndarray of bool, shape (n_c,)
        Those that they move.
    size : float
        Of its largest shape in a pair [m].
    lengths : ndarray of bool
        Which coordinates are lengths.
    joints : tuple of Joint
    """

    name: str
    coordinates: Indices
    free: bool
    mass: float
    links: Mask
    contacts: Mask
    size: float
    lengths: Mask
    joints: tuple[Joint, ...]

    def amount(self, M: Array, r: Array) -> Array:
        """The size in [N] of generalised forces r, shape (..., n), by the inertia M, (n, n)."""
        per = np.linalg.solve(M, r[..., None])[..., 0]
        return np.asarray(np.sqrt(self.mass * np.maximum(np.vecdot(r, per), 0.0)))

    def missing(self, starts: Array, M: Array) -> Missing:
        """The force that would keep the body from starting to move, from its acceleration.

        A joint that stays needs none: what it has of it is a reaction.

        Parameters
        ----------
        starts : ndarray, shape (n,)
            Its acceleration, turned round [m/s^2, rad/s^2].
        M : ndarray, shape (n, n)
            Its inertia [kg, kg m, kg m^2].
        """
        r = M @ starts
        power = np.abs(r * starts)
        if not self.free and (power <= REACTION * power.sum()).any():
            r = np.where(power > REACTION * power.sum(), r, 0.0)
            starts = np.asarray(np.linalg.solve(M, r), dtype=np.float64)
        force, torque = r[self.lengths], r[~self.lengths]
        if self.free:
            S = M[3:6, :3] / M[0, 0]  # [c]x, of the centre of mass
            torque = torque - S @ force
        whole = float(r @ starts)
        turning = float(torque @ starts[~self.lengths]) / (whole or 1.0)
        return Missing(
            amount=math.sqrt(self.mass * max(whole, 0.0)),
            force=float(np.linalg.norm(force)) * (abs(1 - turning) > NOTHING),
            torque=float(np.linalg.norm(torque)) * (abs(turning) > NOTHING),
            r=r,
            turning=turning,
        )

    def named(self, lack: Missing) -> str:
        """The body's name, or names of its joints that lack force."""
        if self.free:
            return self.name
        of = dict(zip(self.coordinates.tolist(), lack.r.tolist(), strict=True))
        return listed(
            [j.name for j in self.joints if any(of[i] for i in range(j.v.start, j.v.stop))]
        )


def bodies(scene: Scene, coupled: tuple[Indices, Indices]) -> tuple[Body, ...]:
    """The groups of un-actuated coordinates of a scene that move together.

    Parameters
    ----------
    scene : Scene
    coupled : (ndarray of int, ndarray of int)
        Rows and columns, from the first un-actuated one on, of entries of M_u that couple joints.
    """
    system = scene.system
    n_a = system.n_a
    joints = [joint for joint in system.joints if not joint.actuated]
    n_u = system.n_v - n_a
    counts = [joint.v.stop - joint.v.start for joint in joints]
    i, j = coupled
    coupling = np.concatenate([np.repeat(np.arange(len(joints)), counts), len(joints) + i])
    coordinate = np.concatenate([np.arange(n_u), j])
    label, _ = connected_components(coupling, coordinate, (len(joints) + n_u, n_u))
    together: dict[int, list[Joint]] = {}
    for joint in joints:
        together.setdefault(int(label[joint.v.start - n_a]), []).append(joint)
    moves = moved_links(system)
    sides = [side for pair in scene.pairs for side in (pair.alpha, pair.beta)]
    of = np.array([side.link for side in sides], dtype=np.int64)
    extents = np.array([side.shape.extent for side in sides])
    pair_of = np.repeat(np.arange(len(scene.pairs)), [pair.n_c for pair in scene.pairs])
    return tuple(
        _body(system, n_a + np.flatnonzero(label == first), own, moves, of, extents, pair_of)
        for first, own in together.items()
    )


def coupled_joints(scene: Simulator, q: Array) -> tuple[Indices, Indices]:
    """Rows and columns, (k,) each, of entries of M_u at q, (n_q,), that couple joints."""
    if scene.system.constant_mass_matrix:  # those of lone rigid bodies couple none
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    i, j = np.nonzero(scene.system.M_u(q))
    return i, j


def moved_links(system: System) -> Mask:
    """Which links each entry of delta_q moves, shape (L, n_v)."""
    column_map = system.column_map
    return np.asarray(column_map.of_coordinates(column_map.moves)[:, 0] != 0)


def _body(
    system: System,
    at: Indices,
    joints: Sequence[Joint],
    moves: Mask,
    of: Indices,
    extents: Array,
    pair_of: Indices,
) -> Body:
    """The body of some coordinates; `of` and `extents` are those of the two sides of each pair."""
    links: Mask = np.asarray(np.any(moves[:, at], axis=1), dtype=np.bool_)
    of_sides = links[of]
    size = extents[of_sides & (of > 0) & (extents < np.inf)].max(initial=0.0) or FARTHEST
    return Body(
        name=joints[0].name.removesuffix("/base"),
        coordinates=at,
        free=len(joints) == 1 and joints[0].free,
        mass=float(system.masses[links].sum()) or 1.0,
        links=links,
        contacts=np.asarray((of_sides[::2] | of_sides[1::2])[pair_of.astype(np.int64)]),
        size=float(size),
        lengths=np.array([system.coordinates[i].unit == "m" for i in at]),
        joints=tuple(joints),
    )
