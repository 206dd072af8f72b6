"""What a run came to: how far free bodies turned and rose, in words and numbers."""

import json

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.lab.grasp import grasp_scenarios
from quasistatic_ref.simulate.trajectory import trajectory_read
from tests.tolerances import ROUNDING


def run_of(out, scenario, *settings):
    flags = [part for setting in settings for part in ("--set", setting)]
    assert main(["run", scenario, "--out", str(out), "--fast", "--json", *flags]) == 0


def test_a_run_tells_how_far_a_free_body_turned_and_rose(tmp_path, capsys):
    # The sphere spins about the vertical only: its angle is the sum of the steps' turns, and its
    # rise the height above its start.
    run_of(tmp_path, "sphere_spin", "steps=80")
    said = json.loads(capsys.readouterr().out)["free_bodies"]["sphere"]
    run = trajectory_read(tmp_path / "sphere_spin.npz")
    turned = np.degrees(run["delta_q"][:, 5].sum())
    rise = 1e3 * (run["q"][:, 2] - run["q"][0, 2]).max()
    assert 1.0 < turned < 180.0
    np.testing.assert_allclose(said["largest_rotation_deg"], turned, rtol=1e3 * ROUNDING, atol=0.0)
    np.testing.assert_allclose(said["largest_rise_mm"], rise, rtol=ROUNDING, atol=0.0)


def test_settings_of_demo_reach_both_cases_but_not_their_torsion():
    cases = grasp_scenarios(["contacts.grip.mu_omega=0.005", "contacts.grip.mu_v=0.3"])
    grip = {
        case: {(p.mu_v, p.mu_omega) for p in scenario.pairs if p.name.startswith("grip")}
        for case, scenario in cases.items()
    }
    assert grip == {"with torsion": {(0.3, 0.005)}, "without torsion": {(0.3, 0.0)}}


def test_a_lift_that_does_not_end_is_not_compared():
    with pytest.raises(ScenarioError, match=r"steps: end at t = 1 s, before the lift does"):
        grasp_scenarios(["steps=100"])


def test_demo_takes_settings_and_refuses_a_wrong_one_before_any_work(tmp_path, capsys):
    assert main(["demo", "--out", str(tmp_path), "--set", "contacts.grip.mu_w=1"]) == 2
    assert "contacts.grip.mu_w" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
