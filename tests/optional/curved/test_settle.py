"""Normals that are off settle on the maximum of the gap near them."""

import numpy as np
import pytest

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.curved import by_coal
from quasistatic_ref.optional.curved.settle import settled
from tests.contact.solids.test_curved_pair import HERE, PAIRS, SOLIDS
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_a_normal_that_is_off_by_a_thousandth_settles_where_it_was(names) -> None:
    a, b = (SOLIDS[name] for name in names)
    random = np.random.default_rng(4)
    settles = 0
    for R, t in closest.poses(6, 29):
        here = ShapeInWorld(a, *HERE)
        there = ShapeInWorld(b, R, t)
        try:
            phi, alpha, beta, n = solid_pair("p", here, there)
        except ContactError:
            continue
        off = n + 3e-4 * random.normal(size=3)
        start = Witness(phi, alpha, beta, off / np.linalg.norm(off))
        gaps = [by_coal.judged(here, there, *way) for way in settled(here, there, start)]
        settles += any(
            way.defect <= CURVED_PAIR and abs(way.phi - phi) <= CURVED_PAIR for way in gaps
        )
    assert settles >= 5
