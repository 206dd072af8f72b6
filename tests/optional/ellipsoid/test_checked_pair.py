"""A pair of the ellipsoid's program, scaled, checked and rounded: closed forms of a point mass."""

from types import SimpleNamespace

import numpy as np
import pytest
from flint import arb, arb_mat

from quasistatic_ref.certify.form import StepForm, exact_matrix
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.optional.ellipsoid.enclosure import (
    Checked,
    _impulses,
    _net,
    checked,
)
from quasistatic_ref.optional.ellipsoid.interior import Pair
from quasistatic_ref.optional.ellipsoid.newton import OPEN, STICKS
from quasistatic_ref.optional.ellipsoid.scaled_blocks import scaled_blocks
from tests.closeness import assert_relative
from tests.helpers import changed, point_on_floor
from tests.tolerances import ROUNDING

M, MU, PHI, H_STEP = 0.3, 0.5, 2e-3, 0.01
"""Mass [kg], friction [-], gap [m] and time step [s] of the point."""
FORCE = np.array([4.0, -1.0, -0.3 * 9.81])
"""Its load [N]."""


def forms_of(step=None):
    """A step in the ellipsoid, its exact form, and the scaled program."""
    step = point_on_floor(M, MU, PHI, FORCE, H_STEP) if step is None else step
    step = step.replace(cone="ellipsoid")
    form = StepForm(step)
    return step, form, scaled_blocks(step, form)


def point_at(delta_q):
    """A displacement [m] without a duality gap."""
    return Checked(exact_matrix(np.array(delta_q)[:, None]), [], arb(0), arb(1))


@pytest.mark.parametrize("k", [1, 2, 3])
def test_a_pair_outside_of_its_cone_in_any_coordinate_is_refused(k):
    """The cone is y_0 >= |(y_1, y_2, y_3)|, here with y_0 = 1."""
    *_, frame = forms_of()
    for share, inside in ((0.99, True), (-0.99, True), (1.01, False), (-1.01, False)):
        y = arb_mat([[1], *([share if i == k else 0.0] for i in (1, 2, 3))])
        found = checked(frame, Pair(arb_mat(3, 1), y))
        assert (found is not None) == inside


def test_the_gap_of_a_pair_is_the_distance_to_the_optimum_of_its_lagrangian_and_its_work():
    """Of m / 2 h |x - h^2 F / m - h p / m|^2 + lam' s, p being the impulse of the contact."""
    step, form, frame = forms_of()
    x = np.array([1e-3, 0.0, 5e-3])
    lam = np.array([0.02, -3e-3, 4e-3, 0.0])
    axes = [step.contacts.n[0], step.contacts.d1[0], step.contacts.d2[0]]
    off = x - H_STEP**2 * FORCE / M - H_STEP / M * lam[:3] @ axes
    s = np.array([PHI, 0.0, 0.0]) + axes @ x
    expected = M / (2 * H_STEP) * off @ off + lam[:3] @ s
    gap = checked(frame, frame.start(x, lam)).gap / form.h
    assert_relative(float(gap), expected, ROUNDING)


def test_net_is_the_impulse_of_the_contact_and_its_zeros_have_no_sign():
    """H x - g = m x / h - h F; -2^-1200 N s is no float64, and rounded to zero."""
    _, form, _ = forms_of(point_on_floor(M, MU, PHI, (4.0, 0.0, -1.0), H_STEP))
    x = np.array([3e-3, 0.0, 5e-3])
    found = point_at(x)
    found.x[1, 0] = -(arb(2) ** -1200)
    net = _net(form, found)
    expected = M * x / H_STEP - H_STEP * np.array([4.0, 0.0, -1.0])
    assert_relative(net, expected, ROUNDING)
    assert not np.signbit(net[1])


def test_impulses_of_a_contact_without_load_are_zeros_without_a_sign():
    step, form, frame = forms_of()
    lam = np.array([0.02, -3e-3, 0.0, -1e-3])
    found = SimpleNamespace(y=[v * form.h for v in map(arb, lam.tolist())])
    found.y[2] = -(arb(2) ** -1200)
    none = _impulses(step, frame, found, [OPEN])
    assert none.tobytes() == np.zeros(4).tobytes()
    some = _impulses(step, frame, found, [STICKS])
    assert_relative(some, lam, ROUNDING)
    assert not np.signbit(some[2])


def test_an_answer_in_si_units_is_one_of_the_program_and_back():
    """Without torsion its row is multiplied by zero, and so is what it carries."""
    _, form, frame = forms_of()
    delta_q = np.array([3e-3, -2e-3, 5e-3])
    lam = np.array([0.02, -3e-3, 4e-3, 7.0])
    x, y = frame.in_form(frame.start(delta_q, lam))
    found_x = [float(v) for v in x.entries()]
    assert_relative(found_x, delta_q, ROUNDING)
    found_lam = [float(m * v / form.h) for m, v in zip(frame.mu, y.entries(), strict=True)]
    assert_relative(found_lam, [*lam[:3], 0.0], ROUNDING)


def test_what_gives_way_moves_by_the_compliance_times_the_force():
    """In the units of the cone: s = mu (gap + J x) + c / h y, where lam = mu y."""
    step, form, _ = forms_of()
    c = 1e-3
    frame = scaled_blocks(step, form, c)
    lam = np.array([0.02, -3e-3, 4e-3, 0.0])
    pair = frame.start(np.array([1e-3, 2e-3, 5e-3]), lam)
    slacks = frame.problem.slacks(*pair).entries()
    s = [float(v * ell * frame.size) for v, ell in zip(slacks, frame.length, strict=True)]
    axes = [step.contacts.n[0], step.contacts.d1[0], step.contacts.d2[0]]
    motion = axes @ np.array([1e-3, 2e-3, 5e-3]) + [PHI, 0.0, 0.0]
    mu = np.array([1.0, MU, MU])
    assert_relative(s[:3], mu * motion + c / H_STEP * lam[:3] / mu, ROUNDING)


def test_the_unit_of_a_block_is_its_largest_entry():
    """Of two walls at x = 0 it is the first entry of both; the second wall has twice the lever."""
    step, *_ = forms_of()
    walls = repeated(step.contacts, [0, 0])
    axes = {"n": np.eye(3)[[0, 0]], "d1": np.eye(3)[[1, 1]], "d2": np.eye(3)[[2, 2]]}
    J = walls.J * np.array([1.0, 2.0])[:, None, None]
    _, _, frame = forms_of(step.replace(contacts=changed(walls, **axes, J=J)))
    first = float(frame.form.A[0, 0] * frame.root[0])
    found = [float(ell) for ell in frame.length]
    assert_relative(found, [first] * 4 + [2 * first] * 4, ROUNDING)


@pytest.mark.parametrize(("phi", "gap"), [(PHI, 1.0), (0.0, 0.0)])
def test_without_a_load_the_largest_gap_is_the_unit(phi, gap):
    *_, frame = forms_of(point_on_floor(M, MU, phi, np.zeros(3), H_STEP))
    found = [float(v) for v in frame.problem.b.entries()]
    assert_relative(np.abs(found), [gap, 0, 0, 0], ROUNDING)
