"""The tables of the friction cones: names, counts, directions, limit surfaces, JSON."""

import numpy as np
import pytest

from quasistatic_ref import StepDataError, solve_step, standard_form
from quasistatic_ref.step.cones import cone, cone_matrix, direction
from quasistatic_ref.step.friction import contact_wrenches, friction_rows
from tests.closeness import assert_close, assert_within
from tests.helpers import changed, random_step
from tests.tolerances import EXACT, ROUNDING

POLYHEDRAL = ("pyramid", "product", "facets-6", "facets-8", "frictionless")
COUNTS = {
    "pyramid": (6, 4),
    "product": (8, 4),
    "facets-10": (12, 10),
    "facets-1024": (1026, 1024),
    "frictionless": (1, 1),
    "ellipsoid": (4, 4),
}


@pytest.mark.parametrize(("name", "counts"), COUNTS.items(), ids=COUNTS)
def test_how_many_multipliers_a_contact_has(name, counts, rng):
    step = random_step(rng, rows=(6, 4)).replace(cone=name)
    assert step.counts.tolist() == list(counts)
    assert step.offsets.tolist() == [0, counts[0], sum(counts)]
    assert standard_form(step).A.shape == (sum(counts), step.n_v)


@pytest.mark.parametrize(
    "name", ["", "facets-", "facets-5", "facets-2", "facets-08", "facets-1026", "facets-٨"],
)  # fmt: skip
def test_another_name_is_refused(name, rng):
    with pytest.raises(StepDataError, match=r"cone: must be one of pyramid, "):
        random_step(rng).replace(cone=name)


@pytest.mark.parametrize("K", [6, 8, 12])
def test_opposite_directions_and_quarter_turns_are_exact(K):
    found = [direction(k, K) for k in range(K)]
    for k, (c, s) in enumerate(found):
        assert (-c, -s) == found[(k + K // 2) % K]
        assert (c, -s) in found
        assert not {c.hex(), s.hex()} & {"-0x0.0p+0"}
        if K % 4 == 0:
            assert (-s, c) == found[(k + K // 4) % K]


def test_four_facets_are_the_pyramid_bit_for_bit(rng):
    contacts = random_step(rng, rows=(6, 6)).contacts
    for found in (friction_rows, lambda _, name: cone_matrix(name)):
        np.testing.assert_array_equal(found(contacts, "facets-4"), found(contacts, "pyramid"))


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
    matrix = cone_matrix(name)
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


def used_share(name, f_1, f_2, tau):
    """The left side of a cone's limit surface, forces in units of mu_v, mu_v, mu_omega."""
    if name == "product":
        return max(abs(f_1) + abs(f_2), abs(tau))
    if name == "frictionless":
        return 0.0 if f_1 == f_2 == tau == 0 else np.inf
    if name == "pyramid":
        return abs(f_1) + abs(f_2) + abs(tau)
    K = int(name.removeprefix("facets-"))
    # The gauge of a regular polygon with corners at 2 pi k / K: its sides' normals are half-way.
    normals = 2 * np.pi * (np.arange(K) + 0.5) / K
    return max(f_1 * np.cos(normals) + f_2 * np.sin(normals)) / np.cos(np.pi / K) + abs(tau)


@pytest.mark.parametrize("name", POLYHEDRAL)
@pytest.mark.parametrize("seed", range(2))
def test_every_wrench_is_inside_of_the_limit_surface(name, seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng, rows=(6, 4, 6)).replace(cone=name)
    contacts = step.contacts
    m = int(step.offsets[-1])
    lam = rng.exponential(size=m) * (rng.uniform(size=m) < 0.7)
    for j, (f_1, f_2, f_n, tau) in enumerate(contact_wrenches(contacts, lam, 0.01, name)):
        units = contacts.mu_v[j], contacts.mu_v[j], contacts.mu_omega[j]
        assert used_share(name, *np.array([f_1, f_2, tau]) / units) <= f_n * (1 + ROUNDING)
        assert contacts.rows[j] == 6 or tau == 0.0


@pytest.mark.parametrize("name", [*POLYHEDRAL, "ellipsoid"])
def test_the_wrenches_do_the_same_generalised_work_as_the_rows(name, rng):
    step = random_step(rng, rows=(6, 4, 6)).replace(cone=name)
    contacts = step.contacts
    lam = rng.exponential(size=int(step.offsets[-1]))
    work = np.zeros(step.n_v)
    for j, (f_1, f_2, f_n, tau) in enumerate(contact_wrenches(contacts, lam, 0.01, name)):
        force = f_1 * contacts.d1[j] + f_2 * contacts.d2[j] + f_n * contacts.n[j]
        work += contacts.J[j].T @ np.array([*force, tau]) * 0.01
    expected = standard_form(step).A.T @ lam
    assert_close(work, expected, ROUNDING)


@pytest.mark.parametrize("name", ["pyramid", "product", "facets-8"])
@pytest.mark.parametrize("seed", range(3))
def test_with_mu_omega_zero_six_rows_and_four_give_the_same_bits(name, seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng, rows=(6, 6, 6))
    contacts = changed(step.contacts, mu_omega=np.zeros(3))
    step = step.replace(contacts=contacts, cone=name)
    four = step.replace(contacts=changed(contacts, rows=(4, 4, 4)))
    six = solve_step(step, "none").delta_q
    np.testing.assert_array_equal(solve_step(four, "none").delta_q, six)
