"""The tables of the friction cones: names, counts, directions, limit surfaces, JSON."""

import numpy as np
import pytest

from quasistatic_ref import StepDataError, standard_form
from quasistatic_ref.numbers.angles import cos_sin_of_turn
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.friction import contact_wrenches
from tests.closeness import assert_close, assert_within
from tests.helpers import random_step
from tests.oracles.cones import COUNTS
from tests.oracles.random_steps import POLYHEDRAL
from tests.tolerances import EXACT


@pytest.mark.parametrize(("name", "counts"), COUNTS.items(), ids=COUNTS)
def test_how_many_multipliers_a_contact_has(name, counts, rng):
    step = random_step(rng, rows=(6, 4)).replace(cone=name)
    assert step.counts.tolist() == list(counts)
    assert step.offsets.tolist() == [0, counts[0], sum(counts)]
    assert standard_form(step).A.shape == (sum(counts), step.n_v)


@pytest.mark.parametrize(
    "name", ["", "facets-", "facets-5", "facets-2", "facets-08", "facets-1026", "facets-٨"],
)  # fmt: skip
def test_an_unknown_name_of_a_cone_is_refused(name, rng):
    with pytest.raises(StepDataError, match=r"cone: must be one of pyramid, "):
        random_step(rng).replace(cone=name)


@pytest.mark.parametrize("K", [6, 8, 12])
def test_opposite_directions_and_quarter_turns_are_exact(K):
    found = [cos_sin_of_turn(k, K) for k in range(K)]
    for k, (c, s) in enumerate(found):
        assert (-c, -s) == found[(k + K // 2) % K]
        assert (c, -s) in found
        assert not {c.hex(), s.hex()} & {"-0x0.0p+0"}
        if K % 4 == 0:
            assert (-s, c) == found[(k + K // 4) % K]


def coefficients(name):
    """What each row combines of d1, d2 and spin, in units of the coefficients of friction."""
    sliding = [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
    if name == "frictionless":
        return [(0, 0, 0)]
    if name == "product":
        return [(t_1, t_2, turn) for turn in (1, -1) for t_1, t_2, _ in sliding]
    if name.startswith("facets-"):
        K = int(name.removeprefix("facets-"))
        angles = [2 * np.pi * k / K for k in range(K)]
        sliding = [(np.cos(angle), np.sin(angle), 0) for angle in angles]
    return [*sliding, (0, 0, 1), (0, 0, -1)]


@pytest.mark.parametrize("name", POLYHEDRAL)
def test_a_cone_function_combines_the_gap_and_the_motions(name):
    expected = np.array([(1.0, *t) for t in coefficients(name)])
    matrix = cone(name).matrix
    assert len(matrix) == len(cone(name).row_names)
    # np.cos rounds its argument, the cone's own cosines are right to an ulp.
    tolerance = 1e-15 if name.startswith("facets-") else EXACT
    assert_within(matrix, expected, tolerance)
    # The leading rows do without torsion: its coefficient is then zero.
    short = np.array([(1.0, t_1, t_2) for t_1, t_2, _ in coefficients(name)])[
        : cone(name).without_torsion
    ]
    assert_within(matrix[: cone(name).without_torsion, :3], short, tolerance)
    assert name == "product" or not matrix[: cone(name).without_torsion, 3].any()


@pytest.mark.parametrize("name", [*POLYHEDRAL, "ellipsoid"])
def test_the_wrenches_do_the_same_generalised_work_as_the_rows(name, rng):
    step = random_step(rng).replace(cone=name)
    contacts = step.contacts
    lam = rng.exponential(size=int(step.offsets[-1]))
    work = np.zeros(step.n_v)
    for j, (f_1, f_2, f_n, tau) in enumerate(contact_wrenches(contacts, lam, 0.01, name)):
        force = f_1 * contacts.d1[j] + f_2 * contacts.d2[j] + f_n * contacts.n[j]
        work += contacts.J[j].T @ np.array([*force, tau]) * 0.01
    expected = standard_form(step).A.T @ lam
    assert_close(work, expected)
