"""What the comparison of the two checkers counts as a disagreement; Node runs in ``.ci/run``."""

from __future__ import annotations

import pytest

from validation.tools.check_verifier import VERIFIER, disagreement
from validation.tools.verifier_files import Case

MOST_LINES = 400
"""Of the second checker, which a reader is to read whole."""


@pytest.mark.parametrize(
    ("refusal", "forged", "verdict", "open_fields", "disagree"),
    [
        (None, (), "verified", (), False),
        (None, (), "not checked", ("gap",), False),
        ("lam[0] is wrong", ("lam",), "refused", (), False),
        ("lam[0] is wrong", ("lam",), "verified", (), True),
        ("lam[0] is wrong", ("lam",), "not checked", ("gap",), True),
    ],
)
def test_what_one_proves_and_the_other_refuses_is_a_disagreement(
    refusal, forged, verdict, open_fields, disagree
):
    case = Case("any", "", "", refusal, frozenset(forged), reason="lam is")
    said = {"verdict": verdict, "reason": "lam is wrong", "notChecked": open_fields}
    assert disagreement(case, said) == disagree
    assert disagreement(case, said | {"reason": "gap is wrong"})


def test_the_second_checker_is_short_and_needs_nothing():
    text = VERIFIER.read_text()
    assert len(text.splitlines()) <= MOST_LINES
    found = [line for line in text.splitlines() if "require(" in line or "import" in line]
    assert len(found) == 1  # the command line, which reads two files
    assert 'require("fs")' in found[0]
