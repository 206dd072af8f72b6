"""Problems made of the steps of scenarios: read back alike, with answers that are proved."""

from os.path import relpath

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.formats.resources import scenario_path
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.for_study import FOLDER, study_problems
from tests.oracles.rational_kkt import refutation

PROBLEMS = '[problems]\nscenarios = ["block_incline", "{own}"]\nfamilies.scenarios = 5\n'


@pytest.fixture
def own(study, tmp_path):
    """A test set of five steps: of a scenario by its name, and of a file."""
    return study(PROBLEMS.format(own=relpath(scenario_path("block_push"), tmp_path))).problems


def test_steps_are_evenly_spaced_and_their_answers_are_proved_by_other_arithmetic(own, tmp_path):
    """Three of the 100 steps of one run, and the two ends of the other."""
    made = study_problems(own, tmp_path, progress=False)
    steps = [one.id for one in made]
    assert steps[:3] == [f"scenarios/block_incline/{s}" for s in (0, 50, 99)]
    assert [name.rpartition("/")[0] for name in steps[3:]] == ["scenarios/block_push"] * 2
    for one in made:
        answer = one.answer
        x = answer.x, answer.net, answer.slack, answer.lam
        assert refutation(one.form.H, one.g, one.form.A, one.b, *x) is None
    read = set_read(tmp_path / FOLDER)
    assert [dict(one.facts) for one in read] == [dict(one.facts) for one in made]
    for one, there in zip(made, read, strict=True):
        assert one.answer.x.tobytes() == there.answer.x.tobytes()


def test_scenarios_of_one_name_are_refused(study):
    with pytest.raises(InputError, match=r"problems\.scenarios: must have different names"):
        study(PROBLEMS.format(own="folder/block_incline.toml"))
