"""What is said where a layer is the first to fail: of wrong answers, never of missing ones."""

from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.usual import usual_sentence
from tests.lab.vectors.committed_cases import VECTORS, answer_file, cases, right_answers


def of_the_pyramid(layer):
    """The right answers to the cases of the pyramid, by id."""
    names = {case.id for case in cases(layer) if case.input.get("cone", "pyramid") == "pyramid"}
    return {name: output for name, output in right_answers(layer).items() if name in names}


def test_a_missing_answer_before_a_wrong_one_hides_nothing(tmp_path):
    rows = of_the_pyramid("rows")
    wrench = of_the_pyramid("wrench")
    for i, output in enumerate(wrench.values()):
        output["wrench"] = [[17.0 + i, 3.0 * i, 11.0 - i, 5.0] for _ in output["wrench"]]
    answer_file(tmp_path, "rows", rows)
    answer_file(tmp_path, "wrench", wrench)
    report = check_answers(tmp_path, VECTORS, ["rows", "wrench"])
    assert report.sentences.count(usual_sentence("wrench")) == 1
    assert usual_sentence("rows") not in report.sentences


def test_what_a_program_does_not_do_is_neither_wrong_nor_missing(tmp_path):
    right = of_the_pyramid("wrench")
    left_out = [case.id for case in cases("wrench") if case.id not in right]
    answers = [{"id": name, "output": output} for name, output in right.items()]
    answers += [{"id": name, "unsupported": True} for name in left_out]
    answer_file(tmp_path, "wrench", {}, answers=answers)
    report = check_answers(tmp_path, VECTORS, ["wrench"])
    assert report.status == 0
    assert report.sentences[-1] == report.verdict
    assert report.verdict == (
        f"right: wrench {len(right)} of {len(cases('wrench'))} ({len(left_out)} not supported)"
    )
