"""Of mistakes without a name it is said which formulas of the plain program they are like."""

import ast

import pytest

from quasistatic_ref.lab.folders import vectors_folder
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.likeness import fingerprints, likely, wrong_fields
from quasistatic_ref.lab.vectors.check.patched import patched_texts, program, text_of_file
from quasistatic_ref.lab.vectors.files import answers_written
from tests.lab.vectors.committed_cases import cases, expected_of
from validation.make.program_changes import changes_of_file

PLANTED = {
    "q (+) delta_q": ("integrate", """integration.py:
- x = a * d[0] - b * d[2] * d[1]
+ x = a * d[0] + b * d[2] * d[1] / 2"""),
    "the velocities of bodies": ("jacobian", """mechanism.py:
- J = np.vstack([J0[:3] - skew(t - t0) @ J0[3:], J0[3:]])
+ J = np.vstack([J0[:3] - skew(t + 2 * t0) @ J0[3:], J0[3:]])"""),
    "the distance of a point to a solid": ("distance", """curved.py:
- excess = np.array([r - R, abs(z) - half])
+ excess = np.array([r - R, abs(z) - 0.95 * half])"""),
    "the table t of a cone": ("rows wrench", """rows.py:
- sides = [[*part_of_turn(mu, k, K), 0] for k in range(K)]
+ sides = [[*part_of_turn(mu, -k, K), 0] for k in range(K)]"""),
    "the net wrench of a body": ("wrench", """wrench.py:
- torque = np.cross(arm, force) + tau * n
+ torque = np.cross(arm, force) + 3 * tau * n"""),
}  # fmt: skip


def checked(folder, layers, patch):
    """The report on the plain program with a patch."""
    for layer in layers.split():
        outputs = {case.id: program(patch)(layer, case.input) for case in cases(layer)}
        answers_written(folder, layer, "planted", outputs)
    return check_answers(folder, vectors_folder())


@pytest.mark.parametrize("subject", PLANTED)
def test_a_planted_mistake_is_like_those_in_the_same_formula(subject, tmp_path):
    layers, patch = PLANTED[subject]
    for file, text in patched_texts(patch).items():
        planted = {ast.unparse(one) for one in ast.parse(text).body}
        assert planted.isdisjoint(o.source for o in changes_of_file(file, text_of_file(file)))
    report = checked(tmp_path, layers, patch)
    assert not any(layer.mistakes for layer in report.layers)
    assert subject in [one.subject for one in report.likely]
    assert any(f"{subject} (" in sentence for sentence in report.sentences)
    assert report.record["likely"][0]["likeness"] == report.likely[0].likeness


def test_a_mistake_that_is_like_none_is_left_without_a_word(tmp_path):
    report = checked(
        tmp_path,
        "selection",
        """candidates.py:
- order = np.argsort(phi, kind="stable")
+ order = np.argsort(np.round(phi, 2), kind="stable")""",
    )
    assert not report.ok
    assert report.likely == ()


def test_nothing_is_said_of_right_answers_nor_of_what_is_like_no_mistake():
    names = [name for name in fingerprints().bits if " " not in name]
    assert likely(set(), names) == ()
    assert likely(set(names[::7]), names) == ()
    assert likely({"derivative/random/0"}, names) == ()


def test_fields_that_were_not_answered_are_left_aside():
    _, _, planted = fingerprints().mistakes[0]
    wrong = {name for name, bit in fingerprints().bits.items() if planted & bit}
    asked = {name.partition(" ")[0] for name in wrong}
    fields = {name for name in wrong if " " in name}
    assert likely(wrong, asked)[0].likeness == 1
    assert likely(wrong - fields, asked)[0].likeness < 1
    unsaid = {name for name in fingerprints().bits if " " in name}
    assert likely(wrong - fields, asked, unsaid)[0].likeness == 1


def test_what_is_free_is_not_wrong():
    for layer in ("qp", "distance"):
        for case in cases(layer):
            record = expected_of(layer)[case.id]
            assert wrong_fields(layer, case.input, record, record["output"]) == set()


def test_a_challenge_asks_the_committed_cases_for_what_has_no_name():
    _, patch = PLANTED["the net wrench of a body"]
    found = challenge(program(patch), layers=["wrench"], cases=20)
    assert found.findings
    assert any("a mistake spoils in the net wrench of a body (" in said for said in found.remarks)
