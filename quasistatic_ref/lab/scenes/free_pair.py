"""Two free bodies that may touch: their closest points, and a capsule next to a box."""

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints, closest_points
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.lab.scenes.systems import body_text, cloud_on, on_link, system_of
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.placed_shape import Capsule
from quasistatic_ref.step.data import Array, Contacts

CORNERS = np.array([[x, 0.0, z] for x in (-0.04, 0.04) for z in (-0.03, 0.03)])
"""Of the box, in its plane [m]."""


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


def capsule_and_box() -> tuple[System, ContactPair, Array]:
    """A planar case: a capsule next to the corners of a box, and q, shape (n_q,)."""
    system = pair_system()
    alpha = on_link(system, "one", Capsule(0.03, 0.05))
    beta = cloud_on(system, "two", CORNERS)
    q = system.integrate(system.q_start, np.r_[0, 0, 0, 0, 0.6, 0, 0.115, 0, 0.035, 0, 0, 0])
    q = system.integrate(q, np.r_[np.zeros(6), 0, 0, 0, 0, -0.35, 0])
    return system, ContactPair("draw", alpha, beta, 0.5, 0, 4, 1), q


def outline() -> dict[str, Array]:
    """What is drawn of it, seen along y: outlines (N, 3), closest points and axes (3,), [m, -]."""
    system, pair, q = capsule_and_box()
    points, contacts = geometry(system, pair, q)
    at = system.kinematics(q)
    t = np.linspace(0, 2 * np.pi, 200)
    capsule = np.stack(
        [0.03 * np.cos(t), 0 * t, 0.03 * np.sin(t) + 0.05 * np.sign(np.sin(t))], axis=1
    )
    box = CORNERS[[0, 1, 3, 2, 0]]
    one = system.link("one")
    two = system.link("two")
    return {
        "capsule": capsule @ at.R[one].T + at.t[one],
        "box": box @ at.R[two].T + at.t[two],
        "alpha": points.alpha[0],
        "beta": points.beta[0],
        "n": contacts.n[0],
        "d1": contacts.d1[0],
        "d2": contacts.d2[0],
        "phi": points.phi,
    }
