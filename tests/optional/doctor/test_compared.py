"""The turn by drag that is said of a run."""

import re

import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.lab.grasp import grasp_report


@pytest.mark.parametrize(
    ("mu_omega", "h"),
    [(1.7e-3, 0.01), *(pytest.param(x, 0.005, marks=pytest.mark.long) for x in (2e-3, 2.05e-3))],
)
def test_a_turn_by_drag_is_that_of_the_whole_run(mu_omega, h):
    """Of the bunny, by some degrees; before it settles by a tenth of one as its grip closes."""
    changes = {"contacts.grip.mu_omega": mu_omega, "h": h, "steps": round(3 / h)}
    scenario = load_scenario("bunny_grasp", changes, fast=True)
    run = scenario.run(progress=False)
    (turns,) = run.findings
    way = float(re.search(r"turns by ([\d.]+) deg in the run, because of drag", turns.cause)[1])
    assert way == pytest.approx(grasp_report(scenario, run)["rotation_deg"], abs=0.12)
    assert run.header.not_looked_at == ""
