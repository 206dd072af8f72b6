"""Drag, Pi and the boundary layer of a run: the formulas, and the header."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import load_trajectory, solve_step
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.optional.doctor.artifacts import (
    drag_share,
    quasi_dynamic_number,
)
from quasistatic_ref.optional.doctor.time_step import SLOW
from tests.closeness import assert_relative
from tests.helpers import changed, point_on_floor, sphere_on_floor
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


def free_body(m, at=0):
    """A system of one free body of mass m whose twist starts at a column of delta_q."""
    base = Floating("body/base", False, slice(at, at + 7), slice(at, at + 6))
    return SimpleNamespace(joints=(base,), mass={"body": m}.__getitem__)


def share_of_drag(body, solution, g):
    (share,) = drag_share(body, [solution.step], [solution.delta_q], solution.wrench[None], g)
    return float(share)


def pulled_without_turning(share, m=0.3, mu_v=0.5, radius=0.04):
    """A ball in steady sliding: pulled by F = share mu_v m g, and kept from rolling by a torque.

    (R8): it rides on mu_v x, where x = h^2 (F - mu_v m g) / m is its motion of a step.
    """
    friction = mu_v * m * G
    x = H**2 * (share - 1) * friction / m
    wrench = (share * friction, 0, -m * G, 0, -radius * friction, 0)
    return sphere_on_floor(m=m, radius=radius, mu_v=mu_v, phi=mu_v * x, wrench=wrench, h=H), x


@pytest.mark.parametrize("share", [1.02, 4.0])
def test_the_share_of_drag_under_weight_is_the_quasi_dynamic_number(share):
    step, x = pulled_without_turning(share)
    solution = solve_step(step)
    body = free_body(0.3)
    Pi = (x / H) / (0.5 * G * H)
    assert_relative(Pi, share - 1, ROUNDING)
    found = [
        share_of_drag(body, solution, G),
        float(quasi_dynamic_number(body, step, solution.delta_q[None], G)[0]),
    ]
    assert_relative(found, Pi, ROUNDING)


def test_the_drag_of_a_falling_body_is_its_weight():
    step = sphere_on_floor(m=0.3, phi=1.0, wrench=(0, 0, -0.3 * G, 0, 0, 0), h=H)
    found = share_of_drag(free_body(0.3), solve_step(step), G)
    assert_relative(found, 1.0, ROUNDING)


def test_a_body_without_freedom_friction_or_weight_has_no_share_of_drag():
    step = sphere_on_floor(m=0.3, phi=1.0, wrench=(0, 0, -0.3 * G, 0, 0, 0), h=H)
    solution = solve_step(step)
    body = free_body(0.3)
    assert np.isnan(share_of_drag(body, solution, 0.0))
    (base,) = body.joints
    flat = Planar("body/base", False, slice(0, 4), slice(0, 3))
    for other in (replace(base, actuated=True), flat):
        body.joints = (other,)
        assert np.isnan(share_of_drag(body, solution, G))


def test_a_run_tells_its_numbers_and_keeps_them_in_its_header(tmp_path, cli):
    # Until t = 0.4 s the sphere sticks: neither speed nor layer. At the end it turns at
    # (tau - mu m g) h / I = 14.7 rad/s and rises by mu_omega h omega = 1.47 mm.
    arguments = ["run", "sphere_spin", "--out", tmp_path]
    printed = cli(*arguments, "--set", "steps=39")
    expected = "largest drag 0 of what friction can bear, largest quasi-dynamic number 0, "
    assert f"{expected}largest boundary layer 0 um" in printed.out
    assert printed.err == ""
    cli(*arguments)
    header = load_trajectory(tmp_path / "sphere_spin.npz").header
    expected = 0.01 * H**2 * 4 * 0.01 * 0.3 * G / 8e-5
    assert_relative(header["largest_boundary_layer"], expected, 3e-3)
    assert 0 < header["quasi_dynamic_number"] < SLOW
    assert 0 < header["largest_drag_share"] < SLOW
