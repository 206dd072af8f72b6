"""The bodies as the paper sees them: q, (+), (-), M_u, gravity and the Jacobians of links.

Every configuration and every generalised vector given or returned here is in the paper's
order, q = [q_a; q_u]; quaternions are [x y z w]. A floating base's entries of delta_q are its
twist [linear; angular] in its own frame [m, rad], and q (+) delta_q = q exp6(delta_q). A planar
base has x, y and the angle of the same twist, in the plane.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError, check_kind
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.column_map import JointColumns
from quasistatic_ref.model.coordinates import paper_order
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.mass import (
    MassMatrix,
    check_mass,
    constant_mass,
    mass_matrix,
    rigid_masses,
)
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.state import State
from quasistatic_ref.model.sums import Sums
from quasistatic_ref.model.tree import Tree
from quasistatic_ref.model.workspace import Workspace
from quasistatic_ref.model.world import trees_of, world_of
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    read_only,
    with_shape,
)
from quasistatic_ref.numbers.blocks import nonzeros, whole
from quasistatic_ref.numbers.pivots import positive_pivots

__all__ = ["Body", "Kinematics", "System"]


class System(Mechanism):
    """Bodies in one world.

    What takes q refuses quaternions, and pairs (cos, sin), that are not of length one;
    :meth:`normalised` mends them, and :meth:`checked` checks the rest of q, too. :meth:`at` checks
    a q once for all that is asked there. States share a workspace: a System is for one thread (who
    takes a step holds `lock`), a copy for another. Copies and pickles read no
    file. Equal systems have equal bodies and trees.

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
    sums, actuated_sums : Sums
        (+) and (-) of all joints, and of the actuated ones.
    column_map : JointColumns
        How links move with the coordinates.
    constant_mass_matrix : bool
        Whether M_u is the same array at every q: un-actuated joints are bases of rigid bodies.
    varying_mass : MassMatrix or None
        What gives M_u at a configuration; None if M_u is constant.
    mass_blocks : ndarray, shape (n_u / 6, 6, 6)
        The diagonal blocks of M_u [kg, kg m, kg m^2]; no blocks unless M_u is constant.
    welded : tuple of str
        Links of pinocchio Models of which these have but the mass of all welded to each other.
    texts : tuple of str
        The URDF of each body; of one that has none, words that only an equal one has.
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
        check_kind(bodies, Iterable, "bodies", "a list of bodies: System([body])")
        every = tuple(bodies)
        for body in every:
            check_kind(
                body, Body, "bodies", "a list of bodies, each as Body or Body.of_pinocchio makes it"
            )
        self._make(every, trees_of(every))

    def __getstate__(self) -> tuple[tuple[Body, ...], tuple[Tree, ...]]:
        return self.bodies, self._trees

    def __setstate__(self, state: tuple[tuple[Body, ...], tuple[Tree, ...]]) -> None:
        self._make(*state)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, System):
            return NotImplemented
        return self.bodies == other.bodies and self._trees == other._trees

    def __hash__(self) -> int:
        return hash(self.bodies)

    def _make(self, bodies: tuple[Body, ...], trees: tuple[Tree, ...]) -> None:
        self._trees = trees
        world = world_of(bodies, trees)
        self._world = world
        self._order = paper_order(world.joints)
        self._workspace = self.workspace()
        self.mimics = world.mimics
        self.texts = tuple(tree.text for tree in trees)
        of_bodies = zip(bodies, trees, strict=True)
        self.welded = tuple(
            f"{body.name}/{link}" for body, tree in of_bodies for link in tree.welded
        )
        super().__init__(
            bodies=bodies,
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
        self.sums = Sums(self.joints)
        self.actuated_sums = Sums(self.actuated)
        self.column_map: JointColumns = JointColumns(world.parts, self._order)
        unactuated = [joint for joint in self.joints if not joint.actuated]
        places = world.places
        self.constant_mass_matrix = constant_mass(places, unactuated)
        self.varying_mass: MassMatrix | None = None
        if not self.constant_mass_matrix:
            inertias = (self.masses, self.centres, self.inertias)
            neutral = self.kinematics(self.neutral())
            mass = mass_matrix(places, unactuated, neutral, self.n_a, inertias)
            self.varying_mass = mass if len(mass.link) else None
            self.constant_M_u = mass.known
            unactuated = []
        self.mass_blocks = read_only(rigid_masses(places, unactuated))
        if not (self.constant_mass_matrix and positive_pivots(self.mass_blocks)):
            check_mass(self.M_u(self.q_start), self.coordinates[self.n_a :], self._roots)

    @cached_property
    def constant_M_u(self) -> Array:
        """M_u, shape (n_u, n_u), where it is constant [kg, kg m, kg m^2]."""
        return whole(self.mass_blocks)

    @cached_property
    def mass_entries(self) -> tuple[Indices, Indices] | None:
        """Rows and columns of the entries of M_u that may be nonzero at any q, (k,) each."""
        masses = (self.mass_blocks if self.constant_mass_matrix else self.constant_M_u) != 0
        if self.varying_mass is not None:
            masses.flat[self.varying_mass.entry] = True
            masses |= masses.T
        return nonzeros(masses)

    def workspace(self) -> Workspace:
        """A new workspace, which no other caller uses."""
        return Workspace(self._world, self._order)

    def neutral(self) -> Array:
        """Configuration with every position zero and bases at the origin, shape (n_q,)."""
        entries: list[float] = []
        for joint in self.joints:
            entries += joint.neutral()
        return np.array(entries)

    def _state_at(self, q: Array) -> SystemState:
        """The state at a q, (n_q,) [m, rad, -], that has been checked."""
        return SystemState(self, q)

    def difference(self, q: ArrayLike, q_next: ArrayLike) -> Array:
        """Change delta_q = q_next (-) q, shape (n_v,): q_next = integrate(q, delta_q)."""
        return self.sums.change(self.at(q).q, self.at(q_next).q)

    def _centre(self, name: str, link: int) -> Array:
        """Where a load acts by default, (3,) [m], in the frame of a link that moves."""
        if name not in self._roots:
            return np.asarray(self.centres[link])
        # The root link's frame is that of the base's joint.
        model, frame = self._world.frames[link - 1]
        return np.asarray(model.inertias[model.frames[frame].parentJoint].lever)


class SystemState(State):
    """A System at one configuration."""

    system: System

    @cached_property
    def _q_parts(self) -> list[Array]:
        """The entries of q of each part of the workspace."""
        return self.system._workspace.q_parts(self.q)

    @cached_property
    def poses(self) -> Array:
        """R' and t of all links and columns' of all joints, shape (12 L + 6 n_x,) [-, m, rad].

        As ``Workspace.poses`` has them.
        """
        return self.system._workspace.poses(self._q_parts)

    @property
    def t(self) -> Array:
        """Origin of each link's frame in the world, shape (L, 3) [m]."""
        L = len(self.system.links)
        return self.poses[9 * L : 12 * L].reshape(L, 3)

    @cached_property
    def kinematics(self) -> Kinematics:
        """Pose and Jacobian of every link."""
        L = len(self.system.links)
        R = np.ascontiguousarray(self.poses[: 9 * L].reshape(L, 3, 3).mT)
        columns = np.ascontiguousarray(self.poses[12 * L :].reshape(-1, 6).T)
        return Kinematics(read_only(R), self.t, read_only(columns), self.system.column_map)

    @cached_property
    def M_u(self) -> Array:
        """Un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        mass = self.system.varying_mass
        return self.system.constant_M_u if mass is None else mass.at(self.kinematics)

    @property
    def masses(self) -> Array:
        """M_u, (n_u, n_u), or its blocks, as :attr:`.State.masses` [kg, kg m, kg m^2]."""
        constant = self.system.constant_mass_matrix
        return self.system.mass_blocks if constant else self.M_u

    def gravity(self, acceleration: ArrayLike) -> Array:
        """Generalised force of gravity, (3,) [m/s^2], shape (n_v,) [N, N m]."""
        down = tuple(with_shape(acceleration, "acceleration", (3,), ModelError).tolist())
        # pinocchio's g(q) stands on the left of M dv + g = tau: it is minus the force.
        return 0.0 - self.system.column_map.order.paper_v(self.gravity_torque(down))

    def gravity_torque(self, down: tuple[float, ...]) -> Array:
        """Minus the force of gravity in pinocchio's order, (n_v,) [N, N m], `down` [m/s^2]."""
        return self.system._workspace.gravity_torque(self._q_parts, down)

    def change_to(self, q_a: ArrayLike) -> Array:
        """Change of the actuated coordinates q_a (-) q, shape (n_a,); ModelError of its shape."""
        system = self.system
        q_a = with_shape(q_a, "q_a", (system.n_q_a,), ModelError)
        system.actuated_units.check(q_a)
        return system.actuated_sums.change(self.q, q_a)

    def changes_to(self, q_a: Array) -> Array:
        """Changes to N targets, (N, n_q_a): shape (N, n_a); errors as of one."""
        self.system.actuated_units.check(q_a)
        return self.system.actuated_sums.changes(self.q, q_a)

    def plus_each(self, delta_q: Array) -> Array:
        """The configurations q (+) each of N changes (N, n_v): shape (N, n_q) [m, rad, -]."""
        return self.system.sums.plus_each(self.q, delta_q)

    def plus(self, delta_q: ArrayLike) -> SystemState:
        """The state at q (+) delta_q, of a change of shape (n_v,) [m, rad]."""
        change = with_shape(delta_q, "delta_q", (self.system.n_v,), ModelError)
        return SystemState(self.system, self.system.sums.plus(self.q, change))
