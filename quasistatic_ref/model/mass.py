"""The un-actuated block M_u of the mass matrix, whether it is constant, and not singular.

M is the sum over the links of J' I J. pinocchio's crba is not used: where a joint mimics another,
it adds to what its last call left behind, and misses products of the mimic's branches.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.model.coordinates import joint_key
from quasistatic_ref.model.joints.joint import Coordinate, Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array, Mask, read_only
from quasistatic_ref.numbers.ordered import crossed, dot, rotated
from quasistatic_ref.numbers.pivots import positive_pivots

JointPlaces = Mapping[str, tuple[pin.Model, int]]
"""The pinocchio model that each joint stands in, and its number there, by its name in the model."""


class MassMatrix:
    """M_u of the links that un-actuated coordinates move, as a function of where the links are.

    The entry of two coordinates is a sum over the links that both move, of
    m nu_i . nu_j + omega_i . I omega_j, with the velocity nu of the link's centre of mass. All
    sums are added up in one fixed order. A joint that alone moves its links, below which no other
    is, has constant entries: they are kept, those of a lone free body as its file says.

    Parameters
    ----------
    column_map : JacobianColumns
    n_a : int
    masses : ndarray, shape (L,)
        [kg]
    centres : ndarray, shape (L, 3)
        [m]
    inertias : ndarray, shape (L, 3, 3)
        As in :class:`~quasistatic_ref.model.system.System` [kg m^2].
    known : ndarray, shape (n_u, n_u)
        The constant entries, 0 elsewhere [kg, kg m, kg m^2].
    constant : ndarray of bool, shape (n_v,)
        Whether a coordinate's entries are there.
    """

    def __init__(
        self,
        column_map: JacobianColumns,
        n_a: int,
        masses: Array,
        centres: Array,
        inertias: Array,
        known: Array,
        constant: Mask,
    ) -> None:
        self.n_u = column_map.n_v - n_a
        self.known = read_only(known)
        unactuated = (column_map.owner >= n_a) & ~constant[column_map.owner]
        # Each link once for each column that moves it.
        self.link, self.column = np.nonzero((column_map.moves[:, 0] > 0) & unactuated)
        self.centre = centres[self.link]
        self.inertia = inertias[self.link]
        owner = column_map.owner[self.column] - n_a
        # Two columns of a link at a time, for the entries on the diagonal and above it. A joint and
        # its mimic have one coordinate: both orders of their columns count in the same entry.
        of_links = np.split(np.arange(len(owner)), np.flatnonzero(np.diff(self.link)) + 1)
        i = np.concatenate([np.repeat(of_link, len(of_link)) for of_link in of_links])
        j = np.concatenate([np.tile(of_link, len(of_link)) for of_link in of_links])
        once = owner[i] <= owner[j]
        self.i = i[once]
        self.j = j[once]
        self.mass = masses[self.link[self.i]]
        self.entry = owner[self.i] * self.n_u + owner[self.j]
        # Where each entry of M is computed: above the diagonal.
        entries = np.arange(self.n_u**2).reshape(self.n_u, self.n_u)
        self.above = np.minimum(entries, entries.T)

    def at(self, kinematics: Kinematics) -> Array:
        """M_u, shape (n_u, n_u) [kg, kg m, kg m^2], exactly symmetric and read-only."""
        if not len(self.link):
            return self.known
        R = kinematics.R[self.link]
        t = kinematics.t[self.link]
        column = kinematics.columns.T[self.column]
        omega = column[:, 3:]
        nu = column[:, :3] + crossed(omega, rotated(R, self.centre) + t)
        turn = rotated(R.transpose(0, 2, 1), omega)  # omega in the link's frame
        spin = rotated(self.inertia, turn)
        terms = self.mass * dot(nu[self.i], nu[self.j]) + dot(turn[self.i], spin[self.j])
        return read_only(self.known + np.bincount(self.entry, terms, self.n_u**2)[self.above])


def mass_matrix(
    places: JointPlaces,
    unactuated: Sequence[Joint],
    kinematics: Kinematics,
    n_a: int,
    inertias: tuple[Array, Array, Array],
) -> MassMatrix:
    """The M_u of un-actuated joints.

    Parameters
    ----------
    places : mapping of str to (pinocchio.Model, int)
    unactuated : sequence of Joint
    kinematics : Kinematics
        Of any configuration, with their columns.
    n_a : int
    inertias : tuple of ndarray, shapes (L,), (L, 3) and (L, 3, 3)
        Masses, centres and inertias of the links, as in :class:`MassMatrix` [kg, m, kg m^2].
    """
    column_map = kinematics.column_map
    n_u = column_map.n_v - n_a
    constant = np.zeros(column_map.n_v, dtype=bool)
    nothing = np.zeros((n_u, n_u))
    full_matrix = MassMatrix(column_map, n_a, *inertias, nothing, constant).at(kinematics)
    known = np.zeros((n_u, n_u))
    for joint in unactuated:
        of_joint = (joint.v.start <= column_map.owner) & (column_map.owner < joint.v.stop)
        moved = (column_map.moves[:, 0, of_joint] > 0).any(axis=1)
        shared = (column_map.moves[moved][:, 0, (column_map.owner >= n_a) & ~of_joint] > 0).any()
        mimicked = np.count_nonzero(of_joint) > joint.v.stop - joint.v.start
        if shared or mimicked or not moves_alone(places, joint):
            continue
        constant[joint.v] = True
        block = (slice(joint.v.start - n_a, joint.v.stop - n_a),) * 2
        known[block] = rigid_masses(places, [joint])[0] if joint.free else full_matrix[block]
    return MassMatrix(column_map, n_a, *inertias, known, constant)


def rigid_masses(places: JointPlaces, joints: Sequence[Joint]) -> Array:
    """Mass matrices (k, 6, 6) of the floating bases of k lone rigid bodies, in their frames."""
    masses = []
    for joint in joints:
        model, number = places[joint_key(joint.name)]
        masses.append(model.inertias[number].matrix())
    return np.array(masses).reshape(-1, 6, 6) + 0.0  # never -0.0


def constant_mass(places: JointPlaces, unactuated: Sequence[Joint]) -> bool:
    """Whether M_u is the same at every q: every un-actuated joint is a lone rigid body's base.

    The mass matrix of a free rigid body is constant in the body's own frame, unless a moving joint
    connects another link to the body.
    """
    return all(joint.free and moves_alone(places, joint) for joint in unactuated)


def moves_alone(places: JointPlaces, joint: Joint) -> bool:
    """Whether no other joint is below a joint."""
    model, number = places[joint_key(joint.name)]
    return number not in list(model.parents)


def check_mass(M_u: Array, coordinates: Sequence[Coordinate], bodies: Iterable[str]) -> None:
    """Refuse a body whose M_u is singular: Eq. :eq:`eq-13` needs it positive definite.

    Parameters
    ----------
    M_u : ndarray, shape (n_u, n_u)
        [kg, kg m, kg m^2].
    coordinates : sequence of Coordinate, length n_u
        The un-actuated ones.
    bodies : iterable of str

    Raises
    ------
    ModelError
    """
    for body in bodies:
        indices = [k for k, c in enumerate(coordinates) if c.name.startswith(f"{body}/")]
        if not positive_pivots(M_u[np.ix_(indices, indices)]):
            problem = (
                "its mass matrix M_u is singular in float64 at the start: an un-actuated "
                "coordinate moves almost no mass; give it some, or actuate it"
            )
            names = [coordinates[k].name for k in indices]
            raise ModelError(problem, field=body, value=names)
