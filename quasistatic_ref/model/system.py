"""The bodies as the paper sees them: q, (+), (-), M_u, gravity and the Jacobians of links.

Every configuration and every generalised vector given or returned here is in the paper's
order, q = [q_a; q_u]; quaternions are [x y z w]. A floating base's entries of delta_q are its
twist [linear; angular] in its own frame [m, rad], and q (+) delta_q = q exp6(delta_q). A planar
base has x, y and the angle of the same twist, in the plane.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from quasistatic_ref.model.body import Body
from quasistatic_ref.model.column_map import JointColumns
from quasistatic_ref.model.coordinates import paper_order, with_shape
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.mass import (
    MassMatrix,
    check_mass,
    constant_mass,
    mass_matrix,
    rigid_masses,
    whole,
)
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.urdf.urdf import body_frame
from quasistatic_ref.model.workspace import Workspace
from quasistatic_ref.model.world import World, world_of
from quasistatic_ref.numbers.arrays import (
    Array,
    read_only,
)
from quasistatic_ref.numbers.pivots import positive_pivots

__all__ = ["Body", "Kinematics", "System"]


class System(Mechanism):
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
    column_map : JointColumns
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
        self._make(world_of(tuple(bodies)))

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
        self._world = world
        self._model = world.model
        self._latest: tuple[bytes, Kinematics] | None = None
        self._order = paper_order(world.joints)
        self._workspace = self.workspace()
        self._frames = [body_frame(world.model, link) for link in world.links[1:]]
        self._M_u: Array | None = None  # if M_u is constant: kept once it has been read
        self.mimics = world.mimics
        self.texts = world.texts
        super().__init__(
            bodies=world.bodies,
            joints=self._order.joints,
            links=world.links,
            roots=world.roots,
            shapes=world.shapes,
            masses=world.masses,
            centres=world.centres,
            inertias=world.inertias,
            q_start=self._order.paper_q(world.start),
            ignored=world.ignored,
            notes=world.notes,
        )
        self.column_map: JointColumns = JointColumns(self._model, self._frames, self._order)
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
        return Workspace(self._world, self._order)

    def neutral(self) -> Array:
        """Configuration with every position zero and bases at the origin, shape (n_q,)."""
        return self._order.paper_q(pin.neutral(self._model))

    def integrate(self, q: ArrayLike, delta_q: ArrayLike) -> Array:
        """Configuration q (+) delta_q, shape (n_q,). In C: screws.c."""
        here = self._entries(q)
        delta_q = with_shape(delta_q, "delta_q", (self.n_v,))
        change = delta_q.tolist()
        there: list[float] = []
        for joint in self.joints:  # in the order of q
            there += joint.moved(here[joint.q], change[joint.v])
        return np.array(there)

    def difference(self, q: ArrayLike, q_next: ArrayLike) -> Array:
        """Change delta_q = q_next (-) q, shape (n_v,): q_next = integrate(q, delta_q)."""
        return _change(self.joints, self._entries(q), self._entries(q_next))

    def actuated_difference(self, q: ArrayLike, q_a: ArrayLike) -> Array:
        """Change of the actuated coordinates q_a (-) q, shape (n_a,).

        Raises
        ------
        ModelError
            Unless q_a has shape (n_q_a,).
        """
        q_a = with_shape(q_a, "q_a", (self.n_q_a,))
        self.actuated_units.check(q_a)
        return _change(self.actuated, self._entries(q), q_a.tolist())

    def _entries(self, q: ArrayLike) -> list[float]:
        """Entries of a q of shape (n_q,), whose quaternions have length one."""
        q = with_shape(q, "q", (self.n_q,))
        self.units.check(q)
        entries: list[float] = q.tolist()
        return entries

    def M_u(self, q: ArrayLike) -> Array:
        """Un-actuated block of the mass matrix at q, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        if self.varying_mass is not None:
            return self.varying_mass.at(self.kinematics(q))
        if self._M_u is None:
            self._M_u = whole(self.mass_blocks)
        return self._M_u

    def gravity_force(self, q: ArrayLike, gravity: ArrayLike) -> Array:
        """Generalised force of gravity at q, shape (n_v,) [N, N m].

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        gravity : array_like, shape (3,)
            Acceleration of free fall in the world frame [m/s^2].
        """
        down = gravity if isinstance(gravity, tuple) else tuple(np.asarray(gravity).tolist())
        # pinocchio's g(q) stands on the left of M dv + g = tau: it is minus the force.
        self.kinematics(q)
        return 0.0 - self._order.paper_v(self._workspace.gravity_torque(down))

    def kinematics(self, q: ArrayLike) -> Kinematics:
        """Pose and Jacobian of every link at q.

        The last result is kept, because the q at the end of a step is the q of the next one.
        """
        q = with_shape(q, "q", (self.n_q,))
        bits = q.tobytes()
        if self._latest is None or self._latest[0] != bits:
            self.units.check(q)
            self._workspace.move(q)
            self._latest = bits, Kinematics(*self._workspace.poses(), self.column_map)
        return self._latest[1]

    def _centre(self, name: str, link: int) -> Array:
        """Where a load acts by default, (3,) [m], in the frame of a link that moves."""
        if name not in self._roots:
            return np.asarray(self.centres[link])
        # The root link's frame is that of the base's joint.
        joint = self._model.frames[self._frames[link - 1]].parentJoint
        return np.asarray(self._model.inertias[joint].lever)


def _change(joints: Sequence[Joint], here: list[float], there: list[float]) -> Array:
    """Entries of delta_q of joints, the first ones in q, from one configuration to another."""
    change: list[float] = []
    for joint in joints:
        change += joint.change(here[joint.q], there[joint.q])
    return np.array(change)
