"""Two free bodies that may touch: their closest points."""

from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.lab.made_steps.systems import body_text, system_of
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import Contacts


def pair_system() -> System:
    """Two free bodies."""
    text = body_text(1.0, (1e-3, 1e-3, 1e-3), com=(0.01, 0.02, -0.01))
    return system_of({"one": text, "two": text})


def geometry(system: System, pair: ContactPair, q: Array) -> tuple[ClosestPoints, Contacts]:
    """Closest points of a pair at q, and the contacts made of them."""
    kinematics = system.kinematics(q)
    points = closest_points((pair,), kinematics)
    between = ContactGeometry(contact_layout((pair,)), system.column_map)
    return points, between.contacts(points, kinematics)
