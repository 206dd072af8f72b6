"""The bodies as the paper sees them: q, (+), (-), M_u, gravity and the Jacobians of links.

Every configuration and every generalised vector given or returned here is in the paper's
order, q = [q_a; q_u]; quaternions are [x y z w]. A floating base's entries of delta_q are its
twist [linear; angular] in its own frame [m, rad], and q (+) delta_q = q exp6(delta_q). A planar
base has x, y and the angle of the same twist, in the plane.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from threading import RLock

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.configuration import (
    UnitParts,
    configuration,
    surely_configurations,
    unit_configuration,
)
from quasistatic_ref.model.coordinates import paper_order, with_shape
from quasistatic_ref.model.joints.joint import Coordinate, Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.mass import (
    MassMatrix,
    check_mass,
    constant_mass,
    mass_matrix,
    rigid_masses,
    whole,
)
from quasistatic_ref.model.named import Named, Values
from quasistatic_ref.model.workspace import Workspace
from quasistatic_ref.model.world import World, world_of
from quasistatic_ref.step.arrays import (
    Array,
    Indices,
    checked_array,
    checked_numbers,
    read_only,
)
from quasistatic_ref.step.ordered import product
from quasistatic_ref.step.pivots import positive_pivots

__all__ = ["Body", "Kinematics", "System"]


class System:
    """Bodies in one world.

    Methods that take q refuse quaternions, and pairs (cos, sin), that are not of length one;
    :meth:`normalised` mends them, and :meth:`checked` checks the rest of q, too. They share a
    workspace: a System is for one thread (who takes a step holds `lock`), a copy for another.
    Copies and pickles hold the URDFs' texts, and read no file. Equal systems have equal bodies and
    files.

    Parameters
    ----------
    bodies : sequence of Body

    Attributes
    ----------
    n_a, n_u, n_v : int
        Actuated, un-actuated and all coordinates of delta_q.
    n_q, n_q_a : int
        Entries of q, and those of them that are actuated.
    joints : tuple of Joint
        In the paper's order, with their slices of q and delta_q; mimic joints are not among them.
    coordinates : tuple of Coordinate, length n_v
    named : Named
        Where the entries of each name stand; see :meth:`of`, :meth:`change_of`, :meth:`placed`.
    mimics : tuple of MimicJoint
    links : tuple of str
        ``"world"``, then ``"gripper/left_finger"``, ...
    masses : ndarray, shape (L,)
        Mass of each link as its file says [kg]; 0 of the world and of links without inertial.
    centres : ndarray, shape (L, 3)
        Each link's centre of mass, in its frame [m].
    inertias : ndarray, shape (L, 3, 3)
        About each link's centre of mass, along the axes of its frame [kg m^2].
    column_map : ColumnMap
        How links move with the coordinates.
    constant_mass_matrix : bool
        Whether M_u is the same array at every q: un-actuated joints are bases of rigid bodies.
    varying_mass : MassMatrix or None
        What gives M_u at a configuration; None if M_u is constant.
    mass_blocks : ndarray, shape (n_u / 6, 6, 6)
        The diagonal blocks of M_u [kg, kg m, kg m^2]; no blocks unless M_u is constant.
    texts : tuple of str
        The URDF of each body.
    shapes : tuple of PlacedShape
        Every collision shape of every URDF, e.g. ``gripper/left_finger#0``.
    q_start : ndarray, shape (n_q,)
    units, actuated_units : UnitParts
        What checks the lengths of quaternions, and of pairs (cos, sin), of q and of q_a.
    ignored : tuple of str
        What stands in the URDFs and the model does not use, e.g. ``arm: link[tool].visual``.
    notes : tuple of str
        Where the model differs from its files, e.g. ``arm: tool#0: mesh replaced by its hull``.

    of_mjcf : bool
        Whether its bodies are those of an MJCF scene, of whose elements a finding then speaks.

    Raises
    ------
    ModelError
        If a URDF is not usable, a name is unknown or taken, or M_u is singular.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> system = qr.System([ball])
    >>> [c.name for c in system.coordinates[:3]]
    ['ball/base.x', 'ball/base.y', 'ball/base.z']
    """

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._make(world_of(bodies))

    def __getstate__(self) -> tuple[World]:
        return (self._world,)

    def __setstate__(self, state: tuple[World]) -> None:
        self._make(*state)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, System):
            return NotImplemented
        return self._world == other._world

    def __hash__(self) -> int:
        return hash(self.bodies)

    def _make(self, world: World) -> None:
        self.bodies = world.bodies
        self._world = world
        self._model = world.model
        self._workspace = Workspace(world)
        self.lock = RLock()
        self._latest: tuple[bytes, Kinematics] | None = None
        self._order = paper_order(world.joints)
        self._frames = world.frames
        self._roots = world.roots
        self._M_u: Array | None = None  # if M_u is constant: kept once it has been read
        self.links = world.links
        self.shapes = world.shapes
        self.mimics = world.mimics
        self.texts = world.texts
        self.masses = world.masses
        self.ignored = world.ignored
        self.notes = world.notes
        self.of_mjcf = False
        self.centres = world.centres
        self.inertias = world.inertias
        for array in (self.masses, self.centres, self.inertias):
            array.setflags(write=False)
        self.joints: tuple[Joint, ...] = self._order.joints
        self.named = Named(self.joints)
        self.units = UnitParts(self.joints)
        self._actuated = [joint for joint in self.joints if joint.actuated]
        self.actuated_units = UnitParts(self._actuated)
        self.coordinates: tuple[Coordinate, ...] = tuple(
            coordinate for joint in self.joints for coordinate in joint.coordinates
        )
        self.n_q = int(self._model.nq)
        self.n_v = len(self.coordinates)
        self.n_a = sum(coordinate.actuated for coordinate in self.coordinates)
        self.n_u = self.n_v - self.n_a
        self.n_q_a = sum(joint.q.stop - joint.q.start for joint in self.joints if joint.actuated)
        self.q_start = read_only(self._order.paper_q(world.start))
        self.column_map = ColumnMap(self._model, world.frames, self._order)
        unactuated = [joint for joint in self.joints if not joint.actuated]
        self.constant_mass_matrix = constant_mass(self._model, unactuated)
        self.varying_mass: MassMatrix | None = None
        if not self.constant_mass_matrix:
            inertias = (self.masses, self.centres, self.inertias)
            neutral = self.kinematics(self.neutral())
            mass = mass_matrix(self._model, unactuated, neutral, self.n_a, inertias)
            self.varying_mass = mass if len(mass.link) else None
            self._M_u = mass.known
            unactuated = []
        self.mass_blocks = read_only(rigid_masses(self._model, unactuated))
        if not (self.constant_mass_matrix and positive_pivots(self.mass_blocks)):
            check_mass(self.M_u(self.q_start), self.coordinates[self.n_a :], self._roots)

    def workspace(self) -> Workspace:
        """A workspace of the caller's own."""
        return Workspace(self._world)

    def joint(self, name: str) -> Joint:
        """Joint of that name, e.g. ``gripper/width``; ModelError if there is none."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        known = [joint.name for joint in self.joints]
        raise ModelError(f"is not a joint{suggestion(name, known)}", field="joint", value=name)

    def link(self, name: str) -> int:
        """Number of a link; the name of a body stands for its root link; ModelError if unknown."""
        if isinstance(name, str) and name in self._roots:
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

    def neutral(self) -> Array:
        """Configuration with every position zero and bases at the origin, shape (n_q,)."""
        return self._order.paper_q(pin.neutral(self._model))

    def integrate(self, q: Array, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,). In C: screws.c."""
        q = with_shape(q, "q", (self.n_q,))
        self.units.check(q)
        delta_q = with_shape(delta_q, "delta_q", (self.n_v,))
        here = q.tolist()
        change = delta_q.tolist()
        there: list[float] = []
        for joint in self.joints:  # in the order of q
            there += joint.moved(here[joint.q], change[joint.v])
        return np.array(there)

    def difference(self, q: Array, q_next: Array) -> Array:
        """Change delta_q = q_next (-) q, shape (n_v,): q_next = integrate(q, delta_q)."""
        q = with_shape(q, "q", (self.n_q,))
        q_next = with_shape(q_next, "q", (self.n_q,))
        self.units.check(q)
        self.units.check(q_next)
        return _change(self.joints, q.tolist(), q_next.tolist())

    def actuated_difference(self, q: Array, q_a: Array) -> Array:
        """Change of the actuated coordinates q_a (-) q, shape (n_a,).

        Raises
        ------
        ModelError
            Unless q_a has shape (n_q_a,).
        """
        q = with_shape(q, "q", (self.n_q,))
        q_a = with_shape(q_a, "q_a", (self.n_q_a,))
        self.units.check(q)
        self.actuated_units.check(q_a)
        return _change(self._actuated, q.tolist(), q_a.tolist())

    def with_actuated(self, q: Array, q_a: Array) -> Array:
        """Copy of q with the actuated entries q_a; ModelError unless they have shape (n_q_a,)."""
        q_a = with_shape(q_a, "q_a", (self.n_q_a,))
        return np.concatenate([q_a, np.asarray(q)[self.n_q_a :]])

    def surely_actuated(self, q_a: Array) -> bool:
        """Whether `checked` would surely change nothing in actuated entries, (steps, n_q_a)."""
        return surely_configurations(self._actuated, q_a)

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
        """Copy of q whose quaternions, and pairs (cos, sin), are divided by their lengths.

        For a q that comes with fewer digits than float64 has: from float32, or from a file.

        Raises
        ------
        ModelError
            If a number is not finite, the shape is not (n_q,), or a length is zero.
        """
        return unit_configuration(self.joints, self.n_q, q)

    def M_u(self, q: Array) -> Array:
        """Un-actuated block of the mass matrix at q, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        if self.varying_mass is not None:
            return self.varying_mass.at(self.kinematics(q))
        if self._M_u is None:
            self._M_u = whole(self.mass_blocks)
        return self._M_u

    def gravity_force(self, q: Array, gravity: ArrayLike) -> Array:
        """Generalised force of gravity at q, shape (n_v,) [N, N m].

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        gravity : array_like, shape (3,)
            Acceleration of free fall in the world frame [m/s^2].
        """
        down = gravity if isinstance(gravity, tuple) else tuple(np.asarray(gravity).tolist())
        # pinocchio's g(q) stands on the left of M dv + g = tau: it is minus the force.
        force = self._workspace.gravity_torque(self._order.model_q(q), down)
        return 0.0 - self._order.paper_v(force)

    def kinematics(self, q: Array) -> Kinematics:
        """Pose and Jacobian of every link at q.

        The last result is kept, because the q at the end of a step is the q of the next one.
        """
        q = with_shape(q, "q", (self.n_q,))
        bits = q.tobytes()
        if self._latest is None or self._latest[0] != bits:
            self.units.check(q)
            self._workspace.move(self._order.model_q(q))
            self._latest = bits, Kinematics(*self._workspace.poses(), self.column_map)
        return self._latest[1]

    def of(self, q: ArrayLike, name: str) -> Array:
        """What q holds of a body, a joint or one entry, as ``block``, ``arm/elbow``, ``block.z``.

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
            If there is no such name, or q has other entries.
        """
        places = self.named.q(name)
        return _taken(q, places, {self.n_q, self.n_q_a}, "q", name)

    def change_of(self, delta_q: ArrayLike, name: str) -> Array:
        """What delta_q, or a generalised force, shape (..., n_v), holds of a name; as :meth:`of`.

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
        if not isinstance(values, Mapping):
            problem = 'must name joints and bodies, as in {"arm/elbow": 0.3}'
            raise ModelError(problem, field="values", value=values)
        before = self.q_start if q is None else self.checked(q)
        return self.checked(self.named.placed(before, values))

    def load(
        self,
        q: Array,
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
        force = checked_array(force, "force", (3,), ModelError)
        torque = checked_array(torque, "torque", (3,), ModelError)
        link = self.link(name)
        if not self.column_map.moves[link].any():
            problem = "has a fixed base, so a load has no effect on it"
            raise ModelError(problem, field="name", value=name)
        centre = self._centre(name, link)
        kinematics = self.kinematics(q)
        if at is None:
            arm = product(kinematics.R[link], centre)
        else:
            arm = checked_array(at, "at", (3,), ModelError) - kinematics.t[link]
        moment = torque + np.cross(arm, force)
        return product(kinematics.J[link].T, np.concatenate([force, moment]))

    def _centre(self, name: str, link: int) -> Array:
        """Where a load acts by default, (3,) [m], in the frame of a link that moves."""
        if name not in self._roots:
            return np.asarray(self.centres[link])
        # The root link's frame is that of the base's joint.
        joint = self._model.frames[self._frames[link - 1]].parentJoint
        return np.asarray(self._model.inertias[joint].lever)

    def pose(self, q: Array, link: str) -> tuple[Array, Array]:
        """Rotation, shape (3, 3), and origin [m], (3,), of a link at q, in the world frame."""
        i = self.link(link)
        kinematics = self.kinematics(q)
        return kinematics.R[i], kinematics.t[i]

    def _root(self, body: str) -> int:
        if body not in self._roots:
            problem = f"is not a body{suggestion(body, self._roots)}"
            raise ModelError(problem, field="body", value=body)
        return self._roots[body]


def _change(joints: Sequence[Joint], here: list[float], there: list[float]) -> Array:
    """Entries of delta_q of joints, the first ones in q, from one configuration to another."""
    change: list[float] = []
    for joint in joints:
        change += joint.change(here[joint.q], there[joint.q])
    return np.array(change)


def _taken(x: ArrayLike, own: Indices, lengths: set[int], field: str, name: str) -> Array:
    """Entries of the last axis of an array, without that axis if there is one entry."""
    if not isinstance(x, np.ndarray | list | tuple):
        problem = f'must be numbers, of one step or of all of a run, run["{field}"]'
        raise ModelError(problem, field=field, value=x)
    x = checked_numbers(x, field, ModelError)
    if x.ndim == 0 or x.shape[-1] not in lengths or own.max() >= x.shape[-1]:
        wanted = " or ".join(map(str, sorted(lengths)))
        problem = f"cannot hold {name}: the last axis must have {wanted} entries"
        if field == "delta_q" and x.ndim and x.shape[-1] > max(lengths):
            problem += f"; further ones are rises of friction: take delta_q[..., :{wanted}]"
        raise ModelError(problem, field=field, value=x.shape)
    taken = x.take(own, axis=-1)
    return taken[..., 0] if len(own) == 1 else taken
