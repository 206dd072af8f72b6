"""Studies whose problems are taken from a set: which ones, and what is refused."""

import numpy as np
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.problems.selection import chosen, problems_taken
from quasistatic_ref.lab.study.problems.study_problems import made, problem_set, problems_read

STUDY = """
[problems]
set = "contact-qp-1"
families = {{ {families} }}

[[runs]]
solvers = ["qpsolvers:daqp"]
"""


def taken(study, families):
    return study(STUDY.format(families=families)).problems


def test_problems_are_spread_over_the_dial_up_to_where_it_ends(members):
    """Angles from 0.1 rad down: those of at least `most`, both ends among them."""
    own = [one for one in members if one.facts["family"] == "wedge"]
    dials = [one.facts["dial"] for one in chosen(own, "wedge", 5, 1e-3)]
    assert len(dials) == 5
    assert max(dials) == 0.1
    assert 1e-3 <= min(dials) < 1.2e-3
    ratios = np.array(sorted(dials)[1:]) / sorted(dials)[:-1]
    np.testing.assert_allclose(ratios, 100 ** (1 / 4), rtol=0.2)


def test_sequences_are_taken_whole_and_in_order(members):
    own = [one for one in members if one.facts["family"] == "sequences"]
    found = chosen(own, "sequences", 30)
    assert [one.facts["sequence"]["place"] for one in found] == [*range(12), *range(12)]


def test_a_study_asks_the_problems_of_a_set_as_they_are(study, members, tmp_path):
    test_set = taken(study, "wedge = { count = 3, most = 1e-3 }, gaps = 2")
    found = problem_set(test_set, tmp_path / "store", progress=False)
    assert [p.facts.family for p in found] == ["gaps"] * 2 + ["wedge"] * 3
    by_id = {one.id: one for one in members}
    for problem in problems_read(tmp_path / "store"):
        one = by_id[problem.id]
        np.testing.assert_array_equal(problem.form.A, one.A.toarray())
        np.testing.assert_array_equal(problem.answer.delta_q, one.answer.x)
    with pytest.raises(InputError, match="holds another test set"):
        problem_set(taken(study, "gaps = 2"), tmp_path / "store", progress=False)


@pytest.mark.parametrize("family", ["sparse", "ellipsoid"])
def test_families_that_studies_have_no_place_for_are_refused(study, family):
    with pytest.raises(InputError, match="studies contain dense rows only"):
        problems_taken(taken(study, f"{family} = 2"))


def test_problems_without_a_solution_come_with_their_farkas_vectors(study, tmp_path):
    """Y >= 0 with b'y > 0 and A'y = 0, but for the rounding of y."""
    test_set = taken(study, "infeasible = 3, gaps = 1")
    made = problem_set(test_set, tmp_path / "store", progress=False)
    read = problems_read(tmp_path / "store")
    assert [p.facts.family for p in read] == ["gaps"] + ["infeasible"] * 3
    for problem, again in zip(made[1:], read[1:], strict=True):
        A, b, y = again.form.A, again.form.b, again.answer.farkas
        np.testing.assert_array_equal(y, problem.answer.farkas)
        assert y.min() >= 0 < b @ y
        assert (abs(A.T @ y) <= 1e-15 * (abs(A).T @ y)).all()
    assert read[0].answer.bound == 0.0


@pytest.mark.parametrize(("text", "words"), [
    ("families = { wedge = 3 }", "is a family of sets; say set"),
    ("families = { time_step = { count = 3, most = 0.01 } }", "has no dial to be turned"),
    ('set = "contact-qp-2"\nfamilies = { wedge = 3 }', "is neither a folder nor a set"),
    ('set = "contact-qp-1"\nfamilies = { wedges = 3 }', "wedges"),
    ("families = { contacts = { most = 3 } }", "count"),
    ('set = "contact-qp-1"\nfamilies = { wedge = { count = 3, most = -1 } }', "must be greater"),
])  # fmt: skip
def test_what_cannot_be_taken_is_said(study, text, words):
    with pytest.raises(InputError, match=words):
        problems_taken(
            study(f"[problems]\n{text}\n[[runs]]\nsolvers = ['qpsolvers:daqp']").problems
        )


def test_a_dial_of_a_study_without_a_set_may_end_elsewhere(study):
    text = "[problems]\nfamilies = { contacts = { count = 4, most = 27 }, mass_ratio = 2 }"
    test_set = study(f"{text}\n[[runs]]\nsolvers = ['qpsolvers:daqp']").problems
    found = [one.step.contacts.n_c for one in made(test_set) if one.family == "contacts"]
    assert found == [1, 3, 9, 27]
