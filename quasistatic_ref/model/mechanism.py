"""The bodies, links, joints and coordinates of a system, and what q holds of each by its name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from threading import RLock
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError, check_kind
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.model.configuration import (
    UnitParts,
    configuration,
    unit_configuration,
)
from quasistatic_ref.model.joints.joint import Coordinate, Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.named import Named, Values
from quasistatic_ref.model.state import State
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    checked_array,
    checked_numbers,
    read_only,
    with_shape,
)
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.quoting import clipped, counted, suggestion
from quasistatic_ref.shapes.placed_shape import PlacedShape


class Mechanism(ABC):
    """Bodies, links, joints and shapes by their names, in the paper's order.

    A System moves them by pinocchio, a MuJoCo scene's by MuJoCo. A step asks for `n_a`, `n_v`,
    `links`, `column_map`, `lock` and :meth:`at`.

    Parameters
    ----------
    bodies : tuple of Body
    joints : tuple of Joint
        In the paper's order, with their slices of q and delta_q; mimic joints are not among them.
    links : tuple of str
        ``"world"``, then ``"gripper/left_finger"``, ...
    roots : mapping of str to int
        Number of each body's root link.
    shapes : tuple of PlacedShape
    masses : ndarray, shape (L,)
        Mass of each link [kg].
    centres : ndarray, shape (L, 3)
        Each link's centre of mass, in its frame [m].
    inertias : ndarray, shape (L, 3, 3)
        About each link's centre of mass, along the axes of its frame [kg m^2].
    q_start : ndarray, shape (n_q,)
        Where it starts [m, rad, -].
    ignored, notes : tuple of str
        As of a System.

    Attributes
    ----------
    n_a, n_u, n_v : int
        Actuated, un-actuated and all coordinates of delta_q.
    n_q, n_q_a : int
        Entries of q, and those of them that are actuated.
    actuated : tuple of Joint
    coordinates : tuple of Coordinate, length n_v
    named : Named
        Where the entries of each name stand; see :meth:`of`, :meth:`change_of`, :meth:`placed`.
    units, actuated_units : UnitParts
        What checks the lengths of quaternions, and of pairs (cos, sin), of q and of q_a.
    lock : RLock
        Held by who takes a step.
    of_mjcf : bool
        Whether its bodies are those of an MJCF scene, of whose elements a finding then speaks.
    margins : mapping of str to float
        Distances at which pairs bear, by the names of pairs whose is not zero [m].
    """

    of_mjcf = False
    margins: Mapping[str, float] = MappingProxyType({})
    column_map: JacobianColumns

    def __init__(
        self,
        *,
        bodies: tuple[Body, ...],
        joints: tuple[Joint, ...],
        links: tuple[str, ...],
        roots: Mapping[str, int],
        shapes: tuple[PlacedShape, ...],
        masses: Array,
        centres: Array,
        inertias: Array,
        q_start: Array,
        ignored: tuple[str, ...] = (),
        notes: tuple[str, ...] = (),
    ) -> None:
        self.bodies = bodies
        self.joints = joints
        self.links = links
        self.shapes = shapes
        self.masses = read_only(masses)
        self.centres = read_only(centres)
        self.inertias = read_only(inertias)
        self.q_start = read_only(q_start)
        self.ignored = ignored
        self.notes = notes
        self.lock = RLock()
        self._roots = roots
        self.named = Named(joints)
        self.actuated = tuple(joint for joint in joints if joint.actuated)
        self.units = UnitParts(joints)
        self.actuated_units = UnitParts(self.actuated)
        self.coordinates: tuple[Coordinate, ...] = tuple(
            coordinate for joint in joints for coordinate in joint.coordinates
        )
        self.n_q = len(q_start)
        self.n_v = len(self.coordinates)
        self.n_a = sum(coordinate.actuated for coordinate in self.coordinates)
        self.n_u = self.n_v - self.n_a
        self.n_q_a = sum(joint.q.stop - joint.q.start for joint in self.actuated)

    def __repr__(self) -> str:
        names = ", ".join(body.name for body in self.bodies)
        links = counted(len(self.links) - 1, "link")
        counts = f"n_a = {self.n_a}, n_u = {self.n_u}, {links}"
        return f"<{type(self).__name__} of {clipped(names) or 'no bodies'}: {counts}>"

    def at(self, q: ArrayLike | State) -> State:
        """The system at a configuration, which is checked here and not again.

        Parameters
        ----------
        q : array_like, shape (n_q,); or State
            A state of this system is returned itself.

        Raises
        ------
        ModelError
            If q has another shape, or a quaternion in it is not of length one.
        """
        if isinstance(q, State):
            if q.system is self:
                return q
            q = q.q
        q = with_shape(q, "q", (self.n_q,), ModelError)
        self.units.check(q)
        return self._state_at(q)

    @abstractmethod
    def _state_at(self, q: Array) -> State:
        """The state at a q, (n_q,) [m, rad, -], that has been checked."""

    def kinematics(self, q: ArrayLike) -> Kinematics:
        """Pose and Jacobian of every link at q, (n_q,)."""
        return self.at(q).kinematics

    def M_u(self, q: ArrayLike) -> Array:
        """Un-actuated block of the mass matrix at q, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        return self.at(q).M_u

    def gravity_force(self, q: ArrayLike, gravity: ArrayLike) -> Array:
        """Generalised force of gravity, (3,) [m/s^2], at q, shape (n_v,) [N, N m]."""
        return self.at(q).gravity(gravity)

    def actuated_difference(self, q: ArrayLike, q_a: ArrayLike) -> Array:
        """Change of the actuated coordinates q_a (-) q, shape (n_a,)."""
        return self.at(q).change_to(q_a)

    def integrate(self, q: ArrayLike, delta_q: ArrayLike) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        return self.at(q).plus(delta_q).q

    @abstractmethod
    def _centre(self, name: str, link: int) -> Array:
        """Where a load on a body or link acts by default, (3,) [m], in the frame of the link."""

    def joint(self, name: str) -> Joint:
        """Joint of that name, e.g. ``gripper/width``; ModelError if there is none."""
        known = {joint.name: joint for joint in self.joints}
        if name not in known:
            raise ModelError(f"is not a joint{suggestion(name, known)}", field="joint", value=name)
        return known[name]

    def link(self, name: str) -> int:
        """Number of a link; the name of a body stands for its root link; ModelError if unknown."""
        check_kind(name, str, "link", "a name")
        if name in self._roots:
            return self._roots[name]
        if name not in self.links:
            known = (*self.links, *self._roots)
            problem = f"is not a link{suggestion(str(name), known)}"
            raise ModelError(problem, field="link", value=name)
        return self.links.index(name)

    def mass(self, body: str) -> float:
        """Mass of all links of a body [kg]."""
        self._root(body)
        of_body = [link.startswith(f"{body}/") for link in self.links]
        return float(self.masses[of_body].sum())

    def with_actuated(self, q: ArrayLike, q_a: ArrayLike) -> Array:
        """Copy of q with the actuated entries q_a; ModelError unless they have shape (n_q_a,)."""
        q_a = with_shape(q_a, "q_a", (self.n_q_a,), ModelError)
        return np.concatenate([q_a, np.asarray(q)[self.n_q_a :]])

    def checked(self, q: ArrayLike) -> Array:
        """Copy of q, finite, of shape (n_q,), its quaternions of length one.

        See :func:`~quasistatic_ref.model.configuration.configuration`.

        Raises
        ------
        ModelError
            If it is not a configuration; the message names the joint.
        """
        return configuration(self.joints, self.n_q, q)

    def normalised(self, q: ArrayLike) -> Array:
        """A copy of q with quaternions and pairs (cos, sin) divided by their lengths.

        For a q that comes with fewer digits than float64 has: from float32, or from a file.

        Raises
        ------
        ModelError
            If a number is not finite, the shape is not (n_q,), or a length is zero.
        """
        return unit_configuration(self.joints, self.n_q, q)

    def of(self, q: ArrayLike, name: str) -> Array:
        """Entries of q of a body, joint or coordinate: ``block``, ``arm/elbow``, ``block.z``.

        Parameters
        ----------
        q : array_like, shape (..., n_q) or (..., n_q_a)
            One configuration, or all of a trajectory; or targets.
        name : str
            See :class:`~quasistatic_ref.model.named.Named`.

        Returns
        -------
        ndarray, shape (...,) for one entry, otherwise (..., entries) [m, rad, -]

        Raises
        ------
        ModelError
            If there is no such name, if it has two meanings, or if q has other entries.
        """
        places = self.named.q(name)
        return _taken(q, places, {self.n_q, self.n_q_a}, "q", name)

    def change_of(self, delta_q: ArrayLike, name: str) -> Array:
        """Entries of delta_q or of a force (..., n_v) of a body, joint or coordinate.

        Its single entries are coordinates, such as ``block/base.rz`` [m, rad; N, N m].
        """
        return _taken(delta_q, self.named.change(name), {self.n_v}, "delta_q", name)

    def placed(self, values: Values, q: ArrayLike | None = None) -> Array:
        """Configuration with named positions and poses, shape (n_q,).

        Parameters
        ----------
        values : mapping of str to object
            As in ``{"arm/elbow": 0.3, "mug": {"xyz": (0, 0, 0.1), "rpy": (0, 0, 0)}}``; see
            :meth:`Named.placed <quasistatic_ref.model.named.Named.placed>`.
        q : array_like, shape (n_q,), optional
            Where all else is; by default the start.

        Raises
        ------
        ModelError
            If there is no such name, or a value is not of its kind.
        """
        before = self.q_start if q is None else self.checked(q)
        return self.checked(self.named.placed(before, values))

    def load(
        self,
        q: ArrayLike,
        name: str,
        force: ArrayLike = (0.0, 0.0, 0.0),
        torque: ArrayLike = (0.0, 0.0, 0.0),
        at: ArrayLike | None = None,
    ) -> Array:
        """Generalised force of a force and a torque on a body or a link, shape (n_v,) [N, N m].

        Loads add up: ``force=system.load(q, "mug", f) + system.load(q, "arm/hand", g)``.

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        name : str
            A link; or a body, which means its root link.
        force, torque : array_like, shape (3,)
            Along the world's axes [N, N m].
        at : array_like, shape (3,), optional
            Where the force acts [m], world frame; by default the centre of mass of the link; of a
            body that of its root link and of the links that fixed joints weld to it.

        Raises
        ------
        ModelError
            If there is no such body or link, or it cannot move, so that a load would move nothing.
        """
        return self.load_at(self.kinematics(q), name, force, torque, at)

    def load_at(
        self,
        kinematics: Kinematics,
        name: str,
        force: ArrayLike,
        torque: ArrayLike,
        at: ArrayLike | None = None,
    ) -> Array:
        """Generalised force of a load, shape (n_v,) [N, N m], where all links are placed already.

        It has the arguments and errors of :meth:`load`, but for the poses at q.

        Raises
        ------
        ModelError
            As :meth:`load`.
        """
        force = checked_array(force, "force", (3,), ModelError)
        torque = checked_array(torque, "torque", (3,), ModelError)
        link = self.link(name)
        if not self.column_map.moves[link].any():
            problem = "has a fixed base, so a load has no effect on it; name a body that moves"
            raise ModelError(problem, field="name", value=name)
        centre = self._centre(name, link)
        if at is None:
            arm = product(kinematics.R[link], centre)
        else:
            arm = checked_array(at, "at", (3,), ModelError) - kinematics.t[link]
        moment = torque + np.cross(arm, force)
        return product(kinematics.J_of([link])[0].T, np.concatenate([force, moment]))

    def pose(self, q: ArrayLike, link: str) -> tuple[Array, Array]:
        """Rotation, shape (3, 3), and origin [m], (3,), of a link at q, in the world frame."""
        i = self.link(link)
        kinematics = self.kinematics(q)
        return kinematics.R[i], kinematics.t[i]

    def _root(self, body: str) -> int:
        if body not in self._roots:
            problem = f"is not a body{suggestion(body, self._roots)}"
            raise ModelError(problem, field="body", value=body)
        return self._roots[body]


def _taken(x: ArrayLike, entries: Indices, lengths: set[int], field: str, name: str) -> Array:
    """Entries of the last axis of an array, without that axis if there is one entry."""
    x = checked_numbers(x, field, ModelError)
    if x.ndim == 0 or x.shape[-1] not in lengths or entries.max() >= x.shape[-1]:
        wanted = " or ".join(map(str, sorted(lengths)))
        problem = f"cannot hold {name}: the last axis must have {wanted} entries"
        if field == "delta_q" and x.ndim and x.shape[-1] > max(lengths):
            problem += f"; further ones are rises of friction: take delta_q[..., :{wanted}]"
        raise ModelError(problem, field=field, value=x.shape)
    taken = x.take(entries, axis=-1)
    return taken[..., 0] if len(entries) == 1 else taken
