"""Problems made of the steps of scenarios, with answers that are proved."""

from quasistatic_ref.files.resources import scenario_path
from quasistatic_ref.lab.study.problems.making import problems_of_runs
from tests.oracles.rational_kkt import refutation


def test_steps_are_evenly_spaced_and_their_answers_are_proved_by_other_arithmetic():
    """Three of the 100 steps of one run, and the two ends of the other, which is a file."""
    scenarios = ["block_incline", str(scenario_path("block_push"))]
    made = problems_of_runs(scenarios, 5)
    steps = [one.id for one in made]
    assert steps[:3] == [f"scenarios/block_incline/{s}" for s in (0, 50, 99)]
    assert [name.rpartition("/")[0] for name in steps[3:]] == ["scenarios/block_push"] * 2
    for one in made:
        answer = one.answer
        claims = {"x": answer.x, "net": answer.net, "slack": answer.slack}
        assert refutation(one.form.H, one.g, one.form.A, one.b, answer.lam, **claims) is None
