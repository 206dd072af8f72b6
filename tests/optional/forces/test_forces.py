"""Contact forces by compliance: unique, continuous, the same from every start and order."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Extra,
    InputError,
    StepInfeasible,
    contact_forces,
    solve_step,
)
from quasistatic_ref.optional.forces.of_group import COMPLIANCE, HARDLY_MOVES, group_compliance
from tests.closeness import assert_relative, assert_within
from tests.helpers import EAST, WEST, changed, point_between_walls, point_on_floor, two_bodies
from tests.made import X, Y, Z, contacts_of, free_step, repeated, rigid_step
from tests.optional.forces.blocks import MU_V, POLYHEDRAL, G, H, M, block, walled_block
from tests.oracles import force_checks as checks
from tests.oracles.loaded_piles import loaded_pile
from tests.oracles.random_steps import drawn
from tests.tolerances import ROUNDING

CONES = (*POLYHEDRAL, "ellipsoid")


def test_a_row_of_a_user_stays_hard():
    """The contacts give way: z = mu_v x - c f_n, of x = 0.1 mm."""
    step = walled_block()
    solution = solve_step(step)
    assert solution.compliant.delta_q[0] == 1e-4
    assert solution.compliant.delta_q[2] < MU_V * 1e-4
    assert contact_forces(step).wrench.tobytes() == solution.forces.tobytes()


def test_rows_that_contradict_each_other_are_proved_to():
    """Of the first of two bodies; that is said of the whole step."""
    step = two_bodies([X], [0.0], np.ones(6))
    own = step.replace(extra=Extra(("a", "b"), np.eye(2, 6)[[0, 0]] * [[1], [-1]], np.ones(2)))
    near = np.zeros(6), np.zeros((1, 4))
    with pytest.raises(StepInfeasible, match="cannot be satisfied by any displacement") as failure:
        contact_forces(own, near=near)
    assert failure.value.step is own


def test_walls_that_overlap_have_forces_only_where_a_solution_is_claimed():
    """Each gives way by 1 mm, f_n = 1 mm / c."""
    step = point_between_walls([EAST, WEST], -1e-3)
    with pytest.raises(StepInfeasible):
        contact_forces(step)
    found = contact_forces(step, near=(np.ones(3), np.zeros((2, 4))))
    assert_relative(found.wrench[:, 2], 1e-3 / found.compliance)
    assert found.imbalance == np.inf  # these forces exert nothing, and delta_q is zero


LOADS = {
    "1500 kg at 1 ms": {"masses": [1500.0], "h": 1e-3},
    "1000 kg on 1 kg": {"masses": [1.0, 1000.0], "h": 1e-2},
    "1 kg on 1000 kg": {"masses": [1000.0, 1.0], "h": 1e-2},
    "a spring of 1e8 N/m": {"masses": [0.1], "h": 1e-2, "spring": 1e8, "press": 100.0},
}


@pytest.mark.parametrize("args", LOADS.values(), ids=LOADS)
def test_forces_bear_the_load_of_each_level_in_every_unit(args):
    """To 1e-6, by the weight above it, at corners alike; a compliance of 1e-9 m/N loses 1e-3."""
    for unit in checks.UNITS:
        scene = loaded_pile(**args, unit=unit)
        found = contact_forces(scene.step)
        f_n = found.wrench[:, 2].reshape(-1, 4)
        assert_relative(f_n.sum(axis=1), scene.borne, checks.LOST)
        assert 0 < found.imbalance < checks.LOST
        if unit == 1.0:
            assert (f_n == f_n[:, :1]).all()
            assert contact_forces(scene.step, 1e-9).imbalance > 1e-3


def test_the_compliance_is_next_to_a_share_of_the_least_mobility():
    """Of a cube's corner 4 h^2 / m, 1 / m of its centre and 3 / m of the lever; of a plate 1 / K.

    It is a power of two, and follows the unit of length, which masses and stiffness do not know.
    """
    m = 3.0
    for args, least in (
        ({}, 4 * H**2 / m),
        ({"spring": 1e9, "press": 1.0}, 1e-9),
        ({"spring": 1e2, "press": 1.0}, 4 * H**2 / m),
    ):
        for unit in checks.UNITS:
            c = group_compliance(loaded_pile([m], H, unit=unit, **args).step)
            assert abs(np.log2(c / (COMPLIANCE * least))) <= 0.5 + ROUNDING
            assert np.log2(c) == round(np.log2(c))


def slider(directions, mu_v=0.5, m=1.0, load=0.0, h=H):
    """One on a rail, which contacts with n = z, d1 = x and d2 = y see move along `directions`."""
    J = np.zeros((len(directions), 4, 1))
    J[:, :3, 0] = directions
    return free_step([[m]], [load], contacts_of(0.0, [np.eye(3)] * len(J), J, mu_v), h)


def test_the_compliance_changes_by_one_power_of_two_at_a_time():
    """Of two contacts of a hinge, at 1 m from its axis and at a distance that falls to 1e-12 m.

    Down to a mobility of HARDLY_MOVES of the other's, c follows the second, which bears much; at
    the axis it bears nothing of the hinge, and c is the first's.
    """
    radii = np.geomspace(1.0, 1e-12, 200)  # b falls by 24 % each time
    c = np.array([group_compliance(slider([X, r * X])) for r in radii])
    assert set(np.diff(np.log2(c))) == {-1.0, 0.0, 1.0}
    assert c[0] == c[-1] == group_compliance(slider([X]))
    assert c.min() == pytest.approx(HARDLY_MOVES * c[0], rel=0.5)


def test_noise_of_phi_changes_forces_by_no_more_than_its_length_over_the_compliance():
    """(R42), in the shares of four corners: (1, -1, -1, 1) / 4 of what the corners differ by."""
    step = block()
    clean = contact_forces(step)
    c = clean.compliance[0]
    phi = 1e-15 * np.array([1.0, -1.0, -1.0, 1.0])
    noisy = contact_forces(step.replace(contacts=changed(step.contacts, phi=phi)))
    change = noisy.wrench[:, 2] - clean.wrench[:, 2]
    assert_relative(change, -phi / c, 1e-3)
    load = clean.wrench[:, 2].sum()
    assert_relative(clean.sensitivity, np.sqrt(4) / (c * load))
    assert np.abs(change).max() <= 1e-15 * clean.sensitivity * load


def scaled_forces(step, wrench):
    """The p of forces: f_n, the others over their coefficients."""
    mu = np.pad(step.contacts.mu, ((0, 0), (1, 0)), constant_values=1.0)
    return wrench[:, [2, 0, 1, 3]] / np.where(mu > 0, mu, np.inf)


def length(step, x):
    """||x||_H, by the definition."""
    return np.sqrt(x @ step.H @ x)


def rigid_optimum(step):
    """An exact optimum: delta_q and the wrenches of contacts that do not give way."""
    rigid = solve_step(step, "none")
    return rigid.delta_q, rigid.wrench


SLIGHT = 1 + 1e-6
"""What rounding adds to a bound."""


def test_r42_noise_and_the_norm_of_forces_at_random(rng):
    """||dx||_H^2 + h c ||dp||^2 <= h ||dp|| ||eps||, and ||p_c|| <= ||p|| of any optimal p.

    Steps of all polyhedral cones, with doubled contacts, penetration and coefficients of 0.
    """
    for _, step in checks.random_steps(25):
        k = step.contacts
        near = rigid_optimum(step)
        p = scaled_forces(step, near[1])
        c = 10.0 ** rng.uniform(-9, -4)
        noise = rng.normal(size=k.n_c) * 10.0 ** rng.uniform(-9, -3)
        moved = step.replace(contacts=repeated(k, range(k.n_c), phi=k.phi + noise))
        noise = moved.contacts.phi - k.phi
        one, other = (contact_forces(of, c, near) for of in (step, moved))
        p_c = scaled_forces(step, one.wrench)
        dp = np.linalg.norm(scaled_forces(step, other.wrench) - p_c)
        dx = length(step, other.delta_q - one.delta_q)
        most = step.h * dp * np.linalg.norm(noise)
        assert dx**2 + step.h * c * dp**2 <= SLIGHT * most
        assert np.linalg.norm(p_c) <= SLIGHT * np.linalg.norm(p)


def test_r43_the_loss_at_random(rng):
    """||x_c - x||_H^2 <= h c p_c'(p - p_c) <= h c ||p||^2 / 4, for any optimal p.

    The imbalance is ||x_c - x||_H over the H^-1 norm of the impulses that the forces exert.
    """
    for _, step in checks.random_steps(25):
        rigid, wrench = rigid_optimum(step)
        p = scaled_forces(step, wrench)
        c = 10.0 ** rng.uniform(-6, -2)
        found = contact_forces(step, c, (rigid, wrench))
        p_c = scaled_forces(step, found.wrench)
        lost = length(step, found.delta_q - rigid) ** 2
        most = step.h * c * np.sum(p * p)
        first = step.h * c * np.sum(p_c * (p - p_c))
        rounded = 1e-13 * most + 1e-30
        assert lost <= SLIGHT * first + rounded
        assert first <= SLIGHT * most / 4 + rounded
        k = step.contacts
        axes = np.stack([k.d1, k.d2, k.n], axis=1)
        J = np.concatenate([axes @ k.J[:, :3], k.J[:, 3:]], axis=1)
        exerted = step.h * np.einsum("ji,jiv->v", found.wrench, J)
        load = np.sqrt(exerted @ np.linalg.solve(step.H, exerted))
        assert_relative(found.imbalance * load, np.sqrt(lost), 1e-9)


def test_r43_what_the_floor_of_a_pile_loses_at_random(rng):
    """Of the weight of N alike c S / n (N + 1) (2 N + 1) / 6, to first order."""
    for N in (1, 2, 5, 8):
        m, h = 10.0 ** rng.uniform(-2, 4), 10.0 ** rng.uniform(-3, -1)
        small = 1e-7
        scene = loaded_pile([m] * N, h)
        f_n = contact_forces(scene.step, small * h**2 / m).wrench[:4, 2].sum()
        lost = 1 - f_n / (N * m * G)
        assert lost == pytest.approx(small / 4 * (N + 1) * (2 * N + 1) / 6, rel=1e-4)


def test_a_group_has_one_compliance_and_groups_their_own():
    step = two_bodies([X, X], [0.0, 0.0], np.ones(6))
    with pytest.raises(InputError, match="one number for all contacts of a group"):
        contact_forces(block(), np.array([1e-9, 1e-9, 1e-9, 2e-9]))
    found = contact_forces(step, np.full(step.contacts.n_c, 1e-9))
    assert found.wrench.tobytes() == contact_forces(step, 1e-9).wrench.tobytes()


@pytest.mark.parametrize("seed", range(4))
def test_r44_parallel_contacts_share_as_a_bed_of_springs(seed):
    """f_j = max(0, a + b'r_j), of one gap for all, with or without friction that is not needed.

    c f_j = max(0, -z_j), and z_j = phi + z + omega x r_j is linear in the places r_j.
    """
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 9))
    places = rng.normal(size=(n, 2)) * 0.1
    places[-1] = places[0]  # a contact that is there twice: two springs are stiffer than one
    bent = np.cross([0.0, 0.0, -M * G], [*(rng.dirichlet(np.ones(n)) @ places), 0.0])
    below = np.column_stack([places, np.full(n, -0.03)])
    wrench = [0, 0, -M * G, *-bent]
    step = rigid_step(M, 0.01, wrench, below, [np.eye(3)] * n, mu_v=MU_V, h=H)
    for cone in ("frictionless", "pyramid"):
        f = contact_forces(step.replace(cone=cone)).wrench[:, 2]
        bears = f > 0
        bed = np.column_stack([np.ones(n), places])
        fit = np.linalg.lstsq(bed[bears], f[bears], rcond=None)[0]
        assert_within(f, np.maximum(0.0, bed @ fit), 1e-9 * M * G)


@pytest.mark.parametrize("seed", range(3))
def test_r44_contacts_that_a_symmetry_exchanges_bear_equal_forces(seed):
    """By whole parts of a turn about the vertical; a mirror x -> -x reverses f_d2 of d1 = y."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    tilt, twist = rng.uniform(0, 0.5), rng.uniform(0, 2 * np.pi)
    start = Rotation.from_euler("zyx", [rng.uniform(0, 6), tilt, twist])
    turns = [Rotation.from_euler("z", 2 * np.pi * k / n) for k in range(n)]
    points = [turn.apply([0.05, 0.0, -0.03]) for turn in turns]
    frames = [(turn * start).as_matrix().T for turn in turns]
    wrench = [0, 0, -M * G, 0, 0, rng.normal() * 0.05]
    step = rigid_step(M, (1e-2, 1e-2, 3e-2), wrench, points, frames, mu_v=MU_V, h=H)
    for cone in ("pyramid", "ellipsoid"):
        forces = contact_forces(step.replace(cone=cone), 1e-9).wrench  # turns are rounded
        assert_within(forces, forces[[0] * n], 1e-9 * M * G)
    n = np.sin(tilt) * np.array([[1.0], [-1.0]]) * X + np.cos(tilt) * Z
    frames = np.stack([[Y, Y], np.cross(n, Y), n], axis=1)
    step = rigid_step(M, 0.01, [0, 0, -M * G, 0, 0, 0], [-points[0], points[0]] * X, frames,
                      mu_v=0.1, h=H)  # fmt: skip
    one, other = contact_forces(step).wrench
    assert_within(one * [1, -1, 1, 1], other, 1e-9 * M * G)
    assert abs(one[1]) > 1e-3


@pytest.mark.parametrize("cone", CONES)
def test_contacts_of_bodies_that_stand_bear_nothing(cone):
    """A step without coordinates: nothing presses on contacts with a gap."""
    contacts = changed(block().contacts, J=np.zeros((4, 4, 0)), phi=np.full(4, 1e-3))
    step = free_step(np.zeros((0, 0)), [], contacts, H).replace(cone=cone)
    assert not solve_step(step).forces.any()


@pytest.mark.parametrize("compliance", [0.0, -1e-9, np.inf, np.nan])
def test_a_compliance_that_is_none_is_refused(compliance):
    with pytest.raises(InputError, match="compliance: must be a positive number"):
        contact_forces(block(), compliance)


def test_contact_forces_do_not_depend_on_backend_start_or_order(monkeypatch):
    """Random steps, one of them by fractions; and a planted fault."""
    for _, step in checks.random_steps(5):
        assert not any(checks.differences(step, oracle=False).values())
    step = drawn(7)
    found = checks.differences(step, oracle=True)
    assert set(found) >= {"backends", "permuted", "definition", "independent"}
    assert not any(found.values())
    wrong = np.nextafter(contact_forces(step).wrench, 1.0)
    monkeypatch.setattr(checks, "independent_forces", lambda *_: wrong)
    assert checks.differences(step, oracle=True)["independent"] == 1


@pytest.mark.parametrize("load", [5e-324, 1e-315])
def test_forces_of_a_tiny_load_are_that_load(load):
    """But for the millionth that the compliance leaves."""
    step = slider([Z], mu_v=0.0, m=0.5, load=-load, h=1.0)
    forces = solve_step(step).forces[0]
    assert forces.tolist() == [0.0, 0.0, pytest.approx(load, rel=1e-6, abs=0.0), 0.0]


@pytest.mark.parametrize("far", [1e4, 1e12])
@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_a_contact_that_bears_nothing_changes_no_force(cone, far):
    """However far away it is; the millionth is what the compliance leaves."""
    near = point_on_floor(m=1.0, force=(1.0, 0.0, -9.81))
    both = repeated(near.contacts, [0, 0], phi=[0.0, far])
    step = near.replace(contacts=both, cone=cone)
    forces = solve_step(step).forces
    assert forces == pytest.approx(np.array([[-1.0, 0.0, 9.81, 0.0], [0.0] * 4]), rel=1e-6)
