"""What may touch what: refusals, and how many contacts a pair makes."""

import numpy as np
import pytest

from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.shapes import Box, HalfSpace, PlacedShape, PointCloud, Sphere

CLOUD, BALL = PointCloud(np.eye(3)), Sphere(0.1)
BOX, FLOOR = Box(np.ones(3)), HalfSpace(np.eye(3)[2], 0.0)


def pair(alpha, beta, link_alpha=0, link_beta=1, k=1):
    a = PlacedShape("a", link_alpha, np.eye(3), np.zeros(3), alpha)
    b = PlacedShape("b", link_beta, np.eye(3), np.zeros(3), beta)
    return ContactPair("grip", a, b, 0.5, 0.01, 6, k)


REFUSALS = {
    "two clouds": ((CLOUD, CLOUD), {}, "grip: two clouds cannot touch"),
    "one link": ((BOX, BALL), {"link_alpha": 2, "link_beta": 2}, "grip: both shapes are fixed to"),
    "two shapes of the world": ((FLOOR, BOX), {"link_beta": 0}, "grip: both shapes are fixed to"),
    "k of two convex shapes": ((BOX, BALL), {"k": 2}, "grip: two convex shapes have one closest"),
}


@pytest.mark.parametrize(("shapes", "more", "says"), REFUSALS.values(), ids=REFUSALS)
def test_a_pair_is_refused(shapes, more, says):
    with pytest.raises(ContactError) as caught:
        pair(*shapes, **more)
    assert str(caught.value).startswith(says)


def test_the_refused_k_is_shown():
    with pytest.raises(ContactError, match=r"k must be 1 \(got 5\)$"):
        pair(BOX, FLOOR, k=5)


def test_a_cloud_makes_k_contacts_or_as_many_as_it_has_points():
    assert [pair(FLOOR, CLOUD, k=k).n_c for k in (1, 2, 3, 4, 100)] == [1, 2, 3, 3, 3]
    assert pair(CLOUD, FLOOR, k=2).n_c == 2
    assert pair(BOX, BALL).n_c == 1


def test_no_pairs_have_an_empty_layout():
    layout = contact_layout([])
    assert layout.names == ()
    assert layout.rows.shape == layout.mu_v.shape == layout.link_alpha.shape == (0,)
