"""What may touch what: refusals, and how many contacts a pair makes."""

import re
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    ContactError,
    ContactPair,
    HalfSpace,
    PointCloud,
    Simulator,
    Sphere,
    System,
    convex_hull,
)
from quasistatic_ref.contact.pairs import ContactLayout
from tests.cases import cases, refusal
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
    "no contacts": ((FLOOR, BOX), {"k": 0}, "grip.k: must be a whole number, 1 or more (got 0)"),
    "two half-spaces": ((FLOOR, FLOOR), {}, "grip: two half-spaces always meet"),
}


@cases("shapes, more, says", REFUSALS)
def test_a_pair_is_refused(shapes, more, says):
    with refusal(ContactError, says):
        pair(*shapes, **more)


BODY = Body.of_shape("ball", BALL, mass=0.3)


@pytest.mark.parametrize("no_shape", [BODY, None])
def test_a_side_that_is_no_placed_shape_is_refused_with_the_remedy(no_shape):
    kind = type(no_shape).__name__
    says = f"System.shapes, for the world's PlacedShape.in_world(name, shape) (got '{kind}')"
    for key in ("alpha", "beta"):
        sides = {"alpha": placed_shape(FLOOR), "beta": placed_shape(BALL, 1)} | {key: no_shape}
        with pytest.raises(ContactError, match=re.escape(says)) as caught:
            ContactPair("grip", **sides, mu_v=0.5, mu_omega=0.0, rows=4, k=1)
        assert caught.value.field == f"grip.{key}"


@pytest.mark.parametrize("no_pairs", [BODY, [BODY]])
def test_an_argument_that_is_no_list_of_pairs_is_refused(no_pairs):
    with pytest.raises(ContactError, match=r"pairs: must be a sequence of ContactPair \(got '"):
        Simulator(System([BODY]), no_pairs, h=0.01, K_q=[])


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
