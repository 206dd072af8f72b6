"""Of faults that no classic mistake explains it is said what the failing cases have in common."""

import pytest

from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.check.patched import program
from tests.lab.vectors.committed_cases import cases, expected_of, report_on, right_answers

PLANTED = {
    "integrate": ("q is wrong with", {"entries of a shift", "joint planar"}, """integration.py:
- x = a * d[0] - b * d[2] * d[1]
+ x = a * d[0] + b * d[2] * d[1]"""),
    "jacobian": ("J is wrong with", {"joint prismatic"}, """mechanism.py:
- own[moving, 0] = pace * along
+ own[moving, 0] = pace * along * (3 if body["joint"] == "prismatic" else 1)"""),
    "rows": ("A is wrong with", {"cone facets"}, """rows.py:
- sides = [[*part_of_turn(mu, k, K), 0] for k in range(K)]
+ sides = [[*part_of_turn(mu, k + 1, K), 0] for k in range(K)]"""),
    "wrench": ("net is wrong with", {"rows 6", "torque"}, """wrench.py:
- torque = np.cross(arm, force) + tau * n
+ torque = np.cross(arm, force) + sign * tau * n"""),
}  # fmt: skip


def answers(layer, patch=""):
    """What the plain program answers, with a patch or without, by id."""
    return {case.id: program(patch)(layer, case.input) for case in cases(layer)}


@pytest.mark.parametrize("layer", PLANTED)
def test_the_place_of_a_fault_is_said(layer):
    head, words, patch = PLANTED[layer]
    report = report_on(layer, answers(layer, patch))
    assert report.mistakes == ()
    said = report.common.partition(" in ")[0]
    assert said.startswith(head)
    assert words <= {*said.removeprefix(f"{head} ").split(" and ")}


def test_one_factor_of_all_wrong_numbers_is_said():
    report = report_on("jacobian", answers("jacobian", PLANTED["jacobian"][-1]))
    assert report.common.endswith("; what is wrong is 3 times the expected")


def test_a_pair_of_shapes_is_said():
    given = right_answers("distance")
    for case in cases("distance"):
        if {case.input[side]["kind"] for side in ("alpha", "beta")} == {"capsule", "box"}:
            given[case.id]["n"] = [-x for x in given[case.id]["n"]]
    said = report_on("distance", given).common
    pair = "shape box and shape capsule"
    assert said.startswith(f"n is wrong with {pair} in 14 of 14 failing cases, and right with")
    assert said.endswith("what is wrong is -1 times the expected")


def test_what_is_not_answered_has_something_in_common_too():
    given = right_answers("jacobian")
    mimics = [case.id for case in cases("jacobian") if "mimic" in str(case.input)]
    kept = {name: output for name, output in given.items() if name not in mimics}
    said = layer_report("jacobian", cases("jacobian"), expected_of("jacobian"), Answers(kept, ""))
    count = len(mimics)
    assert said.common.startswith(f"no output is answered with mimic in {count} of {count} ")


@pytest.mark.parametrize("layer", ["integrate", "wrench", "selection"])
def test_cases_that_have_nothing_in_common_are_left_without_a_word(layer):
    given = dict(list(right_answers(layer).items())[::3])
    said = layer_report(layer, cases(layer), expected_of(layer), Answers(given, ""))
    assert said.count("missing") > 20
    assert said.common == ""
