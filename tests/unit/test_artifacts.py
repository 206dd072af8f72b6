"""Pi and the boundary layer of a run: the formulas, the header, the sentence on standard error."""

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.simulate.artifacts import boundary_layer, quasi_dynamic_number, warning
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.tolerances import SLOW
from tests.helpers import changed, point_on_floor, sphere_on_floor
from tests.scenes import chain_scene
from tests.tolerances import ROUNDING

G, H = 9.81, 0.01


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """Un-actuated floating base: the box only; the arm's base is actuated."""
    return chain_scene(tmp_path_factory.mktemp("scene"))


def test_pi_is_the_speed_of_the_free_base_over_mu_g_h(system):
    (box,) = (j for j in system.joints if j.kind == "floating" and not j.actuated)
    step = point_on_floor(mu_v=0.5, h=H)
    delta_q = np.zeros(system.n_v)
    delta_q[box.v] = [3e-4, 0, 4e-4, 7.0, 8.0, 9.0]  # 0.05 m/s; turning does not count
    Pi = quasi_dynamic_number(system, step, delta_q, G)
    np.testing.assert_allclose(Pi, 0.05 / (0.5 * G * H), rtol=ROUNDING, atol=0.0)
    moved_arm = np.ones(system.n_v)
    moved_arm[box.v] = 0.0
    assert quasi_dynamic_number(system, step, moved_arm, G) == 0.0


def test_pi_takes_the_least_friction_that_is_not_zero_and_needs_some(system):
    step = point_on_floor(mu_v=0.5, h=H)
    delta_q = np.full(system.n_v, 1e-3)
    assert quasi_dynamic_number(system, step, delta_q, 0.0) is None
    smooth = step.replace(contacts=changed(step.contacts, mu_v=[0.0]))
    assert quasi_dynamic_number(system, smooth, delta_q, G) is None


def test_the_layer_of_a_spun_sphere_is_mu_omega_times_its_turn():
    m, mu = 0.3, 0.02
    step = sphere_on_floor(m=m, mu_omega=mu, wrench=(0, 0, -m * G, 0, 0, 3 * mu * m * G))
    solution = solve_step(step)
    expected = mu * solution.delta_q[5]
    assert expected > 1e-5
    np.testing.assert_allclose(boundary_layer(step, solution), expected, rtol=ROUNDING, atol=0.0)


def test_a_contact_without_load_has_no_layer_however_far_it_is():
    step = point_on_floor(phi=1.0, force=(0, 0, -0.3 * G))
    assert boundary_layer(step, solve_step(step)) == 0.0


@pytest.mark.parametrize(("Pi", "warned"), [(None, False), (SLOW, False), (2 * SLOW, True)])
def test_only_a_number_that_is_not_small_is_worth_a_word(Pi, warned):
    said = warning({"quasi_dynamic_number": Pi})
    assert (said is not None) is warned


def test_a_run_tells_both_numbers_and_keeps_them_in_its_header(tmp_path, capsys):
    # Until t = 1 s the sphere sticks: neither speed nor layer. At the end it turns at
    # (tau - mu m g) h / I = 0.981 rad/s and rises by mu_omega h omega = 9.81e-5 m.
    arguments = ["run", "sphere_spin", "--out", str(tmp_path)]
    assert main([*arguments, "--set", "steps=90"]) == 0
    told = capsys.readouterr()
    assert "largest quasi-dynamic number 0, largest boundary layer 0 um" in told.out
    assert told.err == ""
    assert main(arguments) == 0
    header = trajectory_read(tmp_path / "sphere_spin.npz").header
    np.testing.assert_allclose(header["largest_boundary_layer"], 9.81e-5, rtol=2e-3, atol=0.0)
    assert 0 < header["quasi_dynamic_number"] < SLOW


def test_a_falling_body_is_warned_of_in_one_sentence_on_standard_error(tmp_path, capsys):
    # It falls at h g: Pi = h g / (mu g h) = 1 / mu = 2.
    settings = ["bodies.sphere.pose.xyz=[0, 0, 5]", "steps=3"]
    flags = [part for setting in settings for part in ("--set", setting)]
    assert main(["run", "sphere_spin", "--out", str(tmp_path), *flags, "--json"]) == 0
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    assert errors.startswith("quasistatic-ref: the quasi-dynamic number of this run reaches 2:")
    run = load_scenario("sphere_spin", settings).run(progress=False)
    np.testing.assert_allclose(run.header["quasi_dynamic_number"], 2.0, rtol=ROUNDING, atol=0.0)
    assert capsys.readouterr().err == ""  # nor is it said where no progress is shown
