"""The contacts of a step as a simulator poses them: not checked number by number."""

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry, tangents
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.optional.fast.posed import PosedContacts, posed
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.contacts import friction_coefficients
from quasistatic_ref.step.data import Array, Indices


class PosedGeometry(ContactGeometry):
    """Contacts of the same links at every step, with what they have in common formed once.

    Parameters
    ----------
    layout : ContactLayout
    column_map : ColumnMap

    Attributes
    ----------
    in_blocks : bool
        Whether J is in blocks.
    of_contacts : dict of str to ndarray
        What the contacts have in common: friction and rows.
    """

    in_blocks = False

    def __init__(self, layout: ContactLayout, column_map: ColumnMap) -> None:
        super().__init__(layout, column_map)
        self.mu = friction_coefficients(layout.mu_v, layout.mu_omega, layout.rows)
        self.of_contacts = {
            "mu_v": layout.mu_v, "mu_omega": layout.mu_omega, "rows": layout.rows, "mu": self.mu
        }  # fmt: skip
        self.named: tuple[list[int], tuple[str, ...]] = [], ()

    def contacts(self, points: ClosestPoints, kinematics: Kinematics) -> PosedContacts:
        """The contacts of one step, from the closest points of all pairs."""
        n = points.n
        d1, d2 = tangents(n)
        J = self.jacobian(kinematics.columns, points.alpha, points.beta, n)
        for array in (points.phi, n, d1, d2, J):
            read_only(array)
        return self.posed(points, d1, d2, J)

    def posed(self, points: ClosestPoints, d1: Array, d2: Array, J: Array) -> PosedContacts:
        """The contacts at those points, from d1, d2 (n_c, 3) [-], J (n_c, 4, n_v) [m, rad]."""
        measured = {"phi": points.phi, "n": points.n, "d1": d1, "d2": d2, "J": J}
        own = {"name": self.names(points.point), **measured}
        return posed(PosedContacts, self.of_contacts, own)

    def names(self, point: Indices) -> tuple[str, ...]:
        """A name for each contact, from its point's number, shape (n_c,): mostly those before."""
        listed = point.tolist()
        if listed != self.named[0]:
            self.named = listed, self.layout.contact_names(point)
        return self.named[1]
