"""A scene where a run starts: what findings before the run look at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import accumulate, pairwise, starmap

import numpy as np

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.doctor.frame.hulls import CloudHull
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Extra, no_extra
from quasistatic_ref.step.extension import StepExtension

FARTHEST = 1.0
"""Size that stands for that of a half-space [m]."""
SHORT = 1e-6
"""Share of the size of a pair's smaller shape [-] below which a motion counts as zero."""
SAMPLED = 50_000
"""Points of a cloud, every so manyth, of which its hull is formed for findings, at most."""
SEARCHED = 200_000
"""Most entries of a step's J, 4 n_c n_v, of a scene in which J is formed and a step is solved once
more: the exact method starts cold, and takes a second there."""


class Start:
    """A scene in the state in which a run starts, as the checks of findings read it.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
    force : ndarray, shape (n_v,), optional
        What pushes there, without gravity [N, N m].
    """

    def __init__(self, simulator: Simulator, q: Array, force: Array | None = None) -> None:
        self.simulator = simulator
        self.force = force
        self.q_start = q
        self.system = simulator.system
        self.pairs = simulator.pairs
        self.h = simulator.h
        self.gravity = np.array(simulator.gravity)
        self.g = float(np.linalg.norm(self.gravity))  # 0 where its square vanishes
        self.down = self.gravity / (self.g or 1.0)

    @property
    def load_at_start(self) -> Array:
        """Gravity and external loads at the start, shape (n_v,) [N, N m]."""
        return self.simulator.generalised_force(self.q_start, self.force)

    @cached_property
    def kinematics(self) -> Kinematics:
        """Poses and Jacobians of the links at the start."""
        return self.system.kinematics(self.q_start)

    @cached_property
    def points(self) -> ClosestPoints:
        """The contacts."""
        return self.simulator.closest_points(self.kinematics)

    @cached_property
    def extension(self) -> StepExtension | None:
        """The extension of the step at the start, or None."""
        extension = self.simulator.extension
        return None if extension is None else extension(self.q_start)

    @property
    def rows(self) -> Extra:
        """Rows of the extension that are numbers, such as stops of joints."""
        rows = None if self.extension is None else self.extension.rows
        return no_extra(self.system.n_v) if rows is None else rows

    @cached_property
    def moves(self) -> Mask:
        """Which links each entry of delta_q moves, shape (L, n_v)."""
        column_map = self.system.column_map
        return np.asarray(column_map.of_coordinates(column_map.moves)[:, 0] != 0)

    @cached_property
    def driven(self) -> Mask:
        """Which links something actuated moves, shape (L,)."""
        return np.asarray(self.moves[:, : self.system.n_a].any(axis=1))

    @cached_property
    def free(self) -> Mask:
        """Mask of the links that move and that nothing actuates, shape (L,)."""
        return np.asarray(self.moves[:, self.system.n_a :].any(axis=1) & ~self.driven)

    @cached_property
    def free_links(self) -> list[tuple[int, str, list[PlacedShape]]]:
        """Links that a joint without actuator moves, with mass and shapes: number, name and shapes.

        What is known by a cloud alone has the cloud's hull, if that has a volume.
        """
        system = self.system
        moved = self.moves[:, system.n_a : system.n_v].any(axis=1) & (system.masses > 0)
        shapes = {link: [*self._hulls(link)] for link in np.flatnonzero(moved).tolist()}
        return [(link, system.links[link], each) for link, each in shapes.items() if each]

    def _hulls(self, link: int) -> Iterator[PlacedShape]:
        """The solids of a link, or else the convex hulls of its clouds."""
        solids = [placed for placed in self.system.shapes if placed.link == link]
        if solids:
            yield from solids
            return
        clouds = {id(p.shape): p for p in self.sides if p.link == link}
        for placed in clouds.values():
            if isinstance(placed.shape, PointCloud):
                points = placed.shape.points
                hull = CloudHull(points[:: 1 + len(points) // SAMPLED])
                if hull.has_volume:
                    yield replace(placed, name="hull of its points", shape=hull)

    @property
    def actuated(self) -> list[Joint]:
        """The joints and bases that are actuated."""
        return [joint for joint in self.system.joints if joint.actuated]

    @cached_property
    def free_bases(self) -> dict[str, Joint]:
        """The floating bases that nothing actuates, by the names of their bodies."""
        bases = [j for j in self.system.joints if j.free and not j.actuated]
        return {base.name.removesuffix("/base"): base for base in bases}

    @cached_property
    def slices(self) -> list[tuple[ContactPair, slice]]:
        """Each pair with the slice of its contacts."""
        ends = [*accumulate((pair.n_c for pair in self.pairs), initial=0)]
        return list(zip(self.pairs, starmap(slice, pairwise(ends)), strict=True))

    @cached_property
    def pair_of(self) -> Indices:
        """Number of the pair of each contact, shape (n_c,)."""
        counts = np.array([pair.n_c for pair in self.pairs], dtype=np.int64)
        return np.repeat(np.arange(len(self.pairs)), counts)

    @cached_property
    def sizes(self) -> Array:
        """Size of the smaller shape of each contact, shape (n_c,) [m]."""
        return np.array([least(pair) for pair in self.pairs])[self.pair_of]

    def body(self, link: int) -> str:
        """The body of a link; ``"world"`` of link 0."""
        return self.system.links[link].partition("/")[0]

    def bodies(self, pair: ContactPair) -> set[str]:
        """The bodies of a pair."""
        return {self.body(side.link) for side in (pair.alpha, pair.beta)}

    @cached_property
    def pairs_of(self) -> dict[str, list[tuple[ContactPair, slice]]]:
        """The pairs of each body, with the slices of their contacts."""
        of_bodies: dict[str, list[tuple[ContactPair, slice]]] = {}
        for pair, at in self.slices:
            for name in self.bodies(pair):
                of_bodies.setdefault(name, []).append((pair, at))
        return of_bodies

    def numbers_of(self, name: str) -> list[int]:
        """Numbers of the pairs of a body."""
        return sorted(set(self.pair_of[self.of_body(name)].tolist()))

    def of_body(self, name: str) -> Mask:
        """Which contacts are of a body, shape (n_c,)."""
        of = np.zeros(len(self.pair_of), dtype=bool)
        for _, at in self.pairs_of.get(name, ()):
            of[at] = True
        return of

    def signs(self, name: str) -> Array:
        """1 of the contacts whose beta is of a body, else -1, shape (n_c,): n points to it."""
        signs = np.full(len(self.pair_of), -1.0)
        for pair, at in self.pairs_of.get(name, ()):
            signs[at] = 1.0 if self.body(pair.beta.link) == name else -1.0
        return signs

    @property
    def sides(self) -> list[PlacedShape]:
        """The two shapes of each pair."""
        return [side for pair in self.pairs for side in (pair.alpha, pair.beta)]

    @property
    def small(self) -> bool:
        """Whether all of J may be formed, and a step solved once more."""
        return 4 * len(self.simulator.plan.layout.rows) * self.system.n_v <= SEARCHED


def table(start: Start, pair: ContactPair) -> str:
    """The table of a scenario that a pair is of, such as ``contacts.floor``; or a MuJoCo pair."""
    if start.system.of_mjcf:
        return f"contact[{pair.name}]"
    return f"contacts.{pair.name.partition('(')[0]}"


def friction_of(start: Start, coefficient: str, names: str) -> str:
    """Words for the field of a scene that holds mu_v or mu_omega of some tables or pairs."""
    if start.system.of_mjcf:
        number = {"mu_v": "first", "mu_omega": "second"}[coefficient]
        return f"the {number} number of friction of the geoms of {names}"
    return f"{coefficient} of {names}"


def joining(start: Start, names: str) -> str:
    """Words of a remedy: what to add to a scene so that some bodies touch."""
    if start.system.of_mjcf:
        geoms = f"let geoms of {names} touch (contype, conaffinity, and no contact/exclude)"
        return f"{geoms}, or add some"
    return f"add a table [contacts.NAME] of {names}"


def more_points(start: Start, pair: ContactPair, count: int | None = None) -> str:
    """Words of a remedy: how to give a pair more contacts, or as many as `count`."""
    if start.system.of_mjcf:
        return f"split the geoms of {pair.name}, of which each pair has {pair.k} places at most"
    return f"raise k of {table(start, pair)}" + ("" if count is None else f" to {count}")


def side(system: System, placed: PlacedShape) -> str:
    """The name of the link that carries a shape, or of its body, or of the world's shape."""
    link = system.links[placed.link]
    body, _, link_name = link.partition("/")
    if not placed.link:
        return placed.name
    return body if link_name == body else link


def least(pair: ContactPair) -> float:
    """Size of a pair's smaller shape [m]; `FARTHEST` where none has one."""
    return pair.size or FARTHEST


def least_mean(n: Array) -> float:
    """Length m of the least mean of normals, (n, 3), with weights >= 0 of sum 1 [-].

    With weights of sum s the residual's square is s^2 m^2 + (s - 1)^2, at least m^2 / (1 + m^2).
    """
    from scipy.optimize import nnls  # takes as long as a short run

    _, left = nnls(np.vstack([n.T, np.ones(len(n))]), np.array([0.0, 0.0, 0.0, 1.0]))
    return float(left / np.sqrt(1 - left**2)) if left < 1 else np.inf
