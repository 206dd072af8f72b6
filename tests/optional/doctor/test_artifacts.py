"""Pi and the boundary layer of a run: the formulas, and the header."""

import numpy as np
import pytest

from quasistatic_ref import load_trajectory
from quasistatic_ref.optional.doctor.artifacts import quasi_dynamic_number
from quasistatic_ref.optional.doctor.time_step import SLOW
from tests.closeness import assert_relative
from tests.helpers import changed, point_on_floor
from tests.scenes import chain_scene
from tests.tolerances import ROUNDING

G = 9.81
H = 0.01


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """Un-actuated floating base: the box only; the arm's base is actuated."""
    return chain_scene(tmp_path_factory.mktemp("scene"))


def test_pi_is_the_speed_of_the_free_base_over_mu_g_h(system):
    (box,) = (j for j in system.joints if j.free and not j.actuated)
    step = point_on_floor(mu_v=0.5, h=H)
    delta_q = np.zeros(system.n_v)
    delta_q[box.v] = [3e-4, 0, 4e-4, 7.0, 8.0, 9.0]  # 0.05 m/s; turning does not count
    Pi = quasi_dynamic_number(system, step, delta_q[None], G)
    assert_relative(Pi, 0.05 / (0.5 * G * H), ROUNDING)
    moved_arm = np.ones(system.n_v)
    moved_arm[box.v] = 0.0
    assert quasi_dynamic_number(system, step, np.array([delta_q, moved_arm]), G).tolist() == [
        *Pi,
        0.0,
    ]


def test_pi_takes_the_least_friction_that_is_not_zero_and_needs_some(system):
    step = point_on_floor(mu_v=0.5, h=H)
    delta_q = np.full((1, system.n_v), 1e-3)
    assert np.isnan(quasi_dynamic_number(system, step, delta_q, 0.0)).all()
    smooth = step.replace(contacts=changed(step.contacts, mu_v=[0.0]))
    assert np.isnan(quasi_dynamic_number(system, smooth, delta_q, G)).all()


def test_a_run_tells_its_numbers_and_keeps_them_in_its_header(tmp_path, cli):
    # Until t = 0.4 s the sphere sticks: neither speed nor layer. At the end it turns at
    # (tau - mu m g) h / I = 14.7 rad/s and rises by mu_omega h omega = 1.47 mm.
    arguments = ["run", "sphere_spin", "--out", tmp_path]
    printed = cli(*arguments, "--set", "steps=39")
    assert "largest quasi-dynamic number 0, largest boundary layer 0 um" in printed.out
    assert printed.err == ""
    cli(*arguments)
    header = load_trajectory(tmp_path / "sphere_spin.npz").header
    expected = 0.01 * H**2 * 4 * 0.01 * 0.3 * G / 8e-5
    assert_relative(header.largest_boundary_layer, expected, 3e-3)
    assert 0 < header.quasi_dynamic_number < SLOW
