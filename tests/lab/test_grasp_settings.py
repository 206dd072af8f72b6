"""The scenarios of ``demo``: settings reach both of them, and a lift has to end."""

import pytest

from quasistatic_ref import ScenarioError
from quasistatic_ref.lab.grasp import grasp_scenarios


def test_settings_of_demo_reach_both_cases_but_not_their_torsion():
    cases = grasp_scenarios(["contacts.grip.mu_omega=0.005", "contacts.grip.mu_v=0.3"])
    grip = {
        case: {(p.mu_v, p.mu_omega) for p in scenario.pairs if p.name.startswith("grip")}
        for case, scenario in cases.items()
    }
    assert grip == {"with torsion": {(0.3, 0.005)}, "without torsion": {(0.3, 0.0)}}


def test_a_lift_that_does_not_end_is_not_compared():
    with pytest.raises(ScenarioError, match=r"steps: end at t = 1 s; the comparison needs"):
        grasp_scenarios(["steps=100"])


def test_demo_takes_settings_and_refuses_a_wrong_one_before_any_work(tmp_path, cli):
    assert (
        "contacts.grip.mu_w"
        in cli("demo --out", tmp_path, "--set contacts.grip.mu_w=1", status=2).err
    )
    assert list(tmp_path.iterdir()) == []
