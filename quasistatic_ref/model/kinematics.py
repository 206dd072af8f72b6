"""Where every link is at one configuration, and how it moves."""

from dataclasses import dataclass
from functools import cached_property

from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.quoting import counted


@dataclass(frozen=True, eq=False, repr=False)
class Kinematics:
    """Where every link is, and how it moves with delta_q; link 0 is the world.

    ``system.kinematics`` makes it; its constructor checks nothing.

    Parameters
    ----------
    R : ndarray, shape (L, 3, 3)
        Rotation from each link's frame to the world's [-].
    t : ndarray, shape (L, 3)
        Origin of each link's frame in the world [m].
    columns : ndarray, shape (6, n_x)
        One column for each degree of freedom of the joints, in the world frame: the spatial
        velocity of the body that the joint moves, per unit of the joint's coordinate. Rows 0-2:
        velocity of the point fixed to the body that is now at the world's origin [m]; rows 3-5:
        angular velocity [rad].
    column_map : JacobianColumns
        Which columns move a link.

    Examples
    --------
    >>> system = qr.load_scenario("sphere_spin").system
    >>> kinematics: qr.Kinematics = system.kinematics(system.q_start)
    >>> kinematics.t[1], kinematics.J.shape
    (array([0.  , 0.  , 0.05]), (2, 6, 6))
    """

    R: Array
    t: Array
    columns: Array
    column_map: JacobianColumns

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {counted(len(self.t) - 1, 'link')}>"

    @cached_property
    def J(self) -> Array:
        """Jacobian of each link, shape (L, 6, n_v).

        Rows 0-2: velocity of the link's origin, rows 3-5: angular velocity, both in the world
        frame, per unit of delta_q.
        """
        return self.J_of(slice(None))

    def J_of(self, links: slice | list[int]) -> Array:
        """Jacobians of the k links with the given numbers, shape (k, 6, n_v) [m, rad]."""
        J = self.column_map.of_coordinates(self.columns * self.column_map.moves[links])
        J[:, :3] += crossed(J[:, 3:], self.t[links, :, None])  # nu + omega x t
        return J
