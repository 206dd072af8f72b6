"""The test set: the same from the same seed, kept with its answers, readable by qpbenchmark."""

import numpy as np
import pytest

from quasistatic_ref.lab.study.problems import making
from quasistatic_ref.lab.study.problems.families.dials import turned
from quasistatic_ref.lab.study.problems.folder import MANIFEST, problems_begun, set_read
from quasistatic_ref.lab.study.problems.for_study import (
    FOLDER,
    TestSet,
    problems_record,
    study_problems,
)

EACH = {"scenarios": 3, "contacts": 3, "mass_ratio": 4, "bodies": 1}
SET = TestSet(1, EACH, ("block_incline",), "", {"contacts": 30, "bodies": 2})


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("set")
    study_problems(SET, place, progress=False)
    return place


def test_ctrl_c_keeps_the_problems_that_were_made(folder, tmp_path, monkeypatch):
    """No answer is sought twice, but for those in which the keys were pressed; all bits agree."""
    honest = making.dense_answer
    calls = []

    def interrupted(form):
        calls.append(form)
        if len(calls) in (5, 8):
            raise KeyboardInterrupt
        return honest(form)

    monkeypatch.setattr(making, "dense_answer", interrupted)
    for kept in (4, 4 + 2):
        with pytest.raises(KeyboardInterrupt):
            study_problems(SET, tmp_path, progress=False)
        assert len(problems_begun(tmp_path / FOLDER)) == kept
        assert not (tmp_path / FOLDER / MANIFEST).exists()
    whole = study_problems(SET, tmp_path, progress=False)
    assert len(calls) == sum(EACH.values()) + 2
    read = set_read(folder / FOLDER)
    assert problems_record(read) == problems_record(whole)
    assert [dict(one.facts) for one in read] == [dict(one.facts) for one in whole]


def test_the_mass_ratio_is_what_the_dial_says():
    """J, K_q and M_u have 24 bits."""
    ratios = [one.step.M_u[6, 6] / one.step.M_u[0, 0] for one in turned("mass_ratio", 4, 1)]
    np.testing.assert_allclose(ratios, [1, 1e3, 1e6, 1e9], rtol=2.0**-23)


def test_the_condition_number_is_that_of_the_hessian_and_no_less_than_the_mass_ratio(folder):
    """The largest eigenvalue of H over the least; the table has four digits."""
    for one in set_read(folder / FOLDER, ["mass_ratio"]):
        least, *_, largest = np.linalg.eigvalsh(one.H.toarray())
        condition = one.facts["measures"]["condition"]
        np.testing.assert_allclose(condition, largest / least, rtol=1e-3)
        assert condition >= one.facts["mass_ratio"]
