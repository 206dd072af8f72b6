"""Pairs of shapes on links that stand still, and searches of their contacts."""

import numpy as np

from quasistatic_ref import ContactError, ContactPair, PlacedShape
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.closest_points import joined_contacts
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.model.system import Kinematics

__all__ = [
    "found_for",
    "in_world",
    "one_by_one",
    "pair",
    "placed_shape",
    "searched",
    "solid_pair",
    "standing_links",
]


def placed_shape(shape, link=0, R=None, t=(0.0, 0.0, 0.0), name="s"):
    return PlacedShape(name, link, np.eye(3) if R is None else R, np.array(t, dtype=float), shape)


def in_world(shape, t=(0.0, 0.0, 0.0), R=None):
    """A shape at a place of the world, straight unless it is turned."""
    return ShapeInWorld(shape, np.eye(3) if R is None else R, np.array(t))


def standing_links(*poses):
    """Links at given poses (R, t), the world first; nothing moves."""
    R = np.array([np.eye(3), *(pose[0] for pose in poses)])
    t = np.array([np.zeros(3), *(pose[1] for pose in poses)])
    return Kinematics(R, t, np.zeros((6, 0)), None)


def pair(alpha, beta, k=1):
    return ContactPair("p", alpha, beta, 0.5, 0.0, 4, k)


def one_by_one(pairs, kinematics):
    """The contacts of all pairs, each searched by itself."""
    R, t = kinematics.R, kinematics.t
    return joined_contacts([pair_closest_points(one, R, t) for one in pairs])


def searched(search, *arguments):
    """The contacts, or what is said instead."""
    try:
        return search(*arguments)
    except ContactError as refused:
        return str(refused)


def found_for(alpha, beta, kinematics, k=1):
    return closest_points([pair(alpha, beta, k)], kinematics)
