"""Problems made of the steps of scenarios: the same each time, with answers that are proved."""

from os.path import relpath

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.formats.resources import scenario_path
from quasistatic_ref.lab.scenes.rigid import program_step
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.for_study import FOLDER, problems_record, study_problems
from quasistatic_ref.step.groups import groups
from tests.closeness import assert_relative
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
        least, *_, largest = np.linalg.eigvalsh(one.form.H)
        found = one.facts["measures"]["condition"]
        assert_relative(found, largest / least, 1e-3)  # the table has four digits
    read = set_read(tmp_path / FOLDER)
    assert problems_record(read) == problems_record(made)
    assert [dict(one.facts) for one in read] == [dict(one.facts) for one in made]
    again = study_problems(own, tmp_path / "again", progress=False)
    assert problems_record(again) == problems_record(made)


def test_scenarios_of_one_name_are_refused(study):
    with pytest.raises(InputError, match=r"problems\.scenarios: must have different names"):
        study(PROBLEMS.format(own="folder/block_incline.toml"))


def test_boxes_that_a_study_makes_are_apart_or_one_heap(study, tmp_path):
    """Twelve boxes on four points each, and 2 x 2 x 2: 4 pairs with the floor, 12 of boxes."""
    text = "[problems]\nfamilies = { apart = { count = 1, most = 12 }, heap = 1 }\n"
    apart, heap = study_problems(study(text).problems, tmp_path, progress=False)
    assert [(one.id, one.facts["dial"]) for one in (apart, heap)] == [
        ("apart/12/0", 12), ("heap/8/0", 8)]  # fmt: skip
    for one, contacts, parts in ((apart, 12 * 4, 12), (heap, (4 + 12) * 4, 1)):
        assert (one.A.shape[0], one.facts["contacts"]) == (6 * contacts, contacts)
        assert one.sparse
        assert len(groups(program_step(one.H.toarray(), one.g, one.A.toarray(), one.b))) == parts
        answer = one.answer
        numbers = answer.x, answer.net, answer.slack, answer.lam
        assert refutation(one.H.toarray(), one.g, one.A.toarray(), one.b, *numbers) is None
    bearing = np.add.reduceat(apart.answer.lam, np.arange(0, 12 * 24, 24))
    assert (bearing > 0).all()
