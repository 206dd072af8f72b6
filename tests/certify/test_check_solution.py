"""The checker for sceptics, against files that are right, files with one fault, and `verify`."""

import json
from itertools import islice

import numpy as np
import pytest

from quasistatic_ref import Extra, QuasistaticError
from tests.cases import cases
from tests.helpers import verify_refusal
from tests.made import step_sha256, step_text
from tests.oracles.forged_scenes import scenes
from tests.oracles.forgeries import good_file
from tests.oracles.random_steps import steps
from tests.oracles.records import places, value_at, with_value
from tests.oracles.solution_truth import refuted, solution_file
from validation import check_solution as checker
from validation.tools.scripts import ROOT

CHECKER = ROOT / "validation" / "check_solution.py"
ORDER = "active names independent rows, in order"
SCENES = scenes()
STICKS = SCENES["exact", "sticks, six rows of rank four"]


@pytest.fixture
def outcome(tmp_path, capsys):
    """The exit status and the last line of the checker for two texts."""

    def status_and_line(step, solution):
        paths = tmp_path / "step.json", tmp_path / "solution.json"
        paths[0].write_text(step)
        paths[1].write_text(solution)
        status = checker.main(*map(str, paths))
        return status, capsys.readouterr().out.splitlines()[-1]

    return status_and_line


def test_the_checker_imports_the_standard_library_alone():
    lines = CHECKER.read_text().splitlines()
    imported = {line for line in lines if line.startswith(("import ", "from "))}
    allowed = {"import hashlib", "import json", "import sys", "from fractions import Fraction"}
    allowed |= {"from math import lcm", "from operator import add"}
    assert imported == allowed


FAMILIES = ("mixed", "any rows", "any scales", "mixed subnormal", "mixed singular")
FINE = {"cone": "facets-32"}
"""A cone with more facets than random steps have."""


@pytest.mark.parametrize(
    ("family", "changes"), [*((family, {}) for family in FAMILIES), ("mixed", FINE)]
)
def test_answers_to_strange_steps_hold_and_a_last_bit_does_not(tmp_path, count, family, changes):
    """Two or more of each family, besides those that are refused in a sentence."""

    def files():
        for step in (one.replace(**changes) for one in steps(family)):
            try:
                yield step, solution_file(step)
            except QuasistaticError:
                continue

    for step, text in islice(files(), max(2, count // 20)):
        assert refuted(step, text) == []
        assert verify_refusal(tmp_path, step_text(step), text) is None
        record = json.loads(text)
        if record["status"] == "optimal":
            off = float(np.nextafter(record["delta_q"][0], 1.0))
            moved = with_value(record, ("delta_q", 0), off)
            assert refuted(step, json.dumps(moved))[0] == "Eq. (9), delta_q"


def test_each_claim_that_fails_is_named_and_refused_by_verify(outcome, tmp_path):
    """Two are of minimisers on other rows than those of the optimum."""
    good = good_file(STICKS, "exact")
    j, i = good["certificate"]["active"][0]
    idle = next(k for k in range(4) if [0, k] not in good["certificate"]["active"])
    wrong = [
        (STICKS, with_value(good, where, value), line)
        for where, value, line in (
            (("lam", j, i), 2 * good["lam"][j][i], "Eq. (9), lam"),
            (("lam", 0, idle), 1e-9, "Eq. (12), zero elsewhere"),
            (("wrench", 0, 0), 1e9, "wrench"),
            (("certificate", "error_bound"), 1e-9, "certificate"),
            (("certificate", "active"), [[0, 3], [0, 2]], ORDER),
            (("step_sha256",), "0" * 64, "of this step"),
        )
    ]
    touches = SCENES["exact", "touches, but bears nothing"]
    record = good_file(touches, "exact")
    record["certificate"] |= {"active": [[0, 0]], "smallest_active_multiplier": 0.0}
    held = SCENES["exact", "held back by a row of its own"]
    free = held.replace(extra=Extra((), np.zeros((0, held.n_v)), np.zeros(0)))
    other = good_file(free, "exact") | {"step_sha256": step_sha256(held), "lam_extra": [0.0]}
    wrong += [(touches, record, "Eq. (11), positive on active"), (held, other, "Eq. (10)")]
    for step, false, line in wrong:
        texts = step_text(step), json.dumps(false)
        assert outcome(*texts) == (1, f"{line}: FAILS")
        assert verify_refusal(tmp_path, *texts) is not None


def test_minus_zero_is_refused_in_a_solution_and_zero_in_a_step_here_and_by_verify(
    outcome, tmp_path
):
    text, good = step_text(STICKS), good_file(STICKS, "exact")
    zeros = [place for place in places(good) if repr(value_at(good, place)) == "0.0"]
    assert {place[0] for place in zeros} >= {"lam", "wrench", "certificate"}
    for place in zeros:
        wrong = json.dumps(with_value(good, place, -0.0))
        assert outcome(text, wrong) == (1, "zero is written 0.0: FAILS")
        assert "-0.0" in verify_refusal(tmp_path, text, wrong)
    negated = json.dumps(with_value(json.loads(text), ("contacts", 0, "phi"), -0.0))
    assert outcome(negated, json.dumps(good))[0] == 0
    assert verify_refusal(tmp_path, negated, json.dumps(good)) is None


NEARLY_SINGULAR = [[1, 1, 0], [1, 1 + 2**-48, 0], [0, 0, 1]]
NO_FILE = {
    "true for a number": ("solution", ("certificate", "error_bound"), False, "is no finite number"),
    "a number for true": ("solution", ("certificate", "differentiable"), 1, "must be a bool"),
    "a float for a version": ("solution", ("version",), 2.0, "version must be {2}"),
    "a float for rows": ("step", ("contacts", 0, "rows"), 4.0, "rows must be {4, 6}"),
    "true for a count": ("step", ("n_a",), False, "n_a or n_u is no whole number"),
    "a number for a name": ("step", ("contacts", 0, "name"), 7, "name must be a str"),
    "a field too many": ("solution", ("note",), "", "solution.note is missing, or unknown"),
    "a field too few": ("step", ("tau_u",), ..., "step.tau_u is missing, or unknown"),
    "no symmetric matrix": ("step", ("M_u", 0, 2), 0.1, "M_u is not symmetric"),
    "a pivot of 4e-15": ("step", ("M_u",), NEARLY_SINGULAR, "M_u is not positive definite"),
    "friction below zero": ("step", ("contacts", 0, "mu_v"), -0.5, "mu_v or mu_omega is negative"),
    "a left-handed frame": ("step", ("contacts", 0, "n"), [0, 0, -1], "no right-handed"),
    "no table": ("step", (), [], "is no table of fields"),
    "no table of claims": ("solution", ("certificate",), [], "only certificates of kind exact"),
}  # fmt: skip
"""What each is: the file, the field, what stands there, and what the checker says."""


@cases("file, where, value, words", NO_FILE)
def test_a_file_of_no_known_format_is_refused_by_the_checker_and_by_verify(
    outcome, tmp_path, file, where, value, words
):
    texts = {"step": step_text(STICKS), "solution": solution_file(STICKS)}
    texts[file] = json.dumps(with_value(json.loads(texts[file]), where, value))
    status, line = outcome(*texts.values())
    assert (status, words in line) == (2, True), line
    assert verify_refusal(tmp_path, *texts.values()) is not None


def test_a_field_that_is_there_twice_and_files_that_are_none_are_refused(outcome, capsys):
    solution = solution_file(STICKS)
    for text in (
        '{"cone": "pyramid", ' + solution[1:],
        solution.replace('{"kind"', '{"kind": 1, "kind"'),
    ):
        status, line = outcome(step_text(STICKS), text)
        assert (status, "a field is there twice" in line) == (2, True)
    for paths, words in (
        ((), "STEP.json and SOLUTION.json are asked for"),
        (("/dev/zero",) * 2, "Expecting value"),
    ):
        assert checker.main(*paths) == 2
        assert words in capsys.readouterr().out


def test_the_checker_says_of_which_claims_it_is_no_judge(outcome):
    for (kind, _), step in SCENES.items():
        status, line = outcome(step_text(step), json.dumps(good_file(step, kind)))
        judged = kind in ("exact", "infeasible")
        assert status == (0 if judged else 2), line
