"""What may touch what: refusals, and how many contacts a pair makes."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    Box,
    ContactError,
    ContactPair,
    HalfSpace,
    PointCloud,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact.pairs import ContactLayout
from tests.contact.still import placed_shape

CLOUD = PointCloud(np.eye(3))
BALL = Sphere(0.1)
BOX = Box(np.ones(3))
FLOOR = HalfSpace(np.eye(3)[2], 0.0)


def pair(alpha, beta, link_alpha=0, link_beta=1, k=1, **more):
    sides = placed_shape(alpha, link_alpha, name="a"), placed_shape(beta, link_beta, name="b")
    return ContactPair("grip", *sides, 0.5, 0.01, 6, k, **more)


REFUSALS = {
    "two clouds": ((CLOUD, CLOUD), {}, "grip: two clouds cannot touch"),
    "one link": ((BOX, BALL), {"link_alpha": 2, "link_beta": 2}, "grip: both shapes are fixed to"),
    "two shapes of the world": ((FLOOR, BOX), {"link_beta": 0}, "grip: both shapes are fixed to"),
    "no contacts": ((FLOOR, BOX), {"k": 0}, "grip.k: must be a whole number, 1 or more (got 0)"),
    "two half-spaces": ((FLOOR, FLOOR), {}, "grip: two half-spaces always meet"),
}


@pytest.mark.parametrize(("shapes", "more", "says"), REFUSALS.values(), ids=REFUSALS)
def test_a_pair_is_refused(shapes, more, says):
    with pytest.raises(ContactError) as caught:
        pair(*shapes, **more)
    assert str(caught.value).startswith(says)


def test_two_solids_make_k_contacts_or_as_many_as_they_have_candidates():
    # A box has 8 corners, a ball and a half-space none; two squares cross eight times at most; the
    # closest pair is one more.
    assert [pair(FLOOR, BOX, k=k).n_c for k in (1, 4, 9, 100)] == [1, 4, 9, 9]
    assert pair(BOX, BOX, k=100).n_c == 8 + 8 + 8 + 1
    assert pair(FLOOR, BALL, k=100).n_c == 1
    assert [pair(FLOOR, CLOUD, k=k).n_c for k in (2, 100)] == [2, 3]  # of the points of a cloud


def test_a_mesh_that_is_not_convex_is_refused_unless_its_hull_will_do():
    dented = replace(convex_hull(np.eye(4)[:, :3]), excess=0.2)
    with pytest.raises(ContactError, match=r"the mesh of b is not convex: .* 20 % more; say hull"):
        pair(FLOOR, dented)
    assert pair(FLOOR, dented, k=5, hull=True).n_c == 5


def test_a_place_is_numbered_within_its_pair():
    none = np.zeros(4)
    links = np.zeros(4, int)
    layout = ContactLayout(("a", "b", "a", "a"), links, links, none, none, links)
    assert layout.slots == ("a/0", "b/0", "a/1", "a/2")
