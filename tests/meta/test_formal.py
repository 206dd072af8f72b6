"""The theorems of validation/formal: each is asked for its axioms, and shown where docs say it."""

import re

from tests.pages import ROOT

SOURCE = (ROOT / "validation" / "formal" / "theorems.v").read_text("utf-8")
PROVED = re.findall(r"^(?:Theorem|Corollary) (\w+)", SOURCE, re.MULTILINE)


def test_each_theorem_is_asked_for_its_axioms():
    asked = re.findall(r"^Print Assumptions (\w+)\.$", SOURCE, re.MULTILINE)
    assert sorted(asked) == sorted(PROVED)


def test_each_theorem_is_named_where_docs_say_it():
    page = (ROOT / "docs" / "exactness.md").read_text("utf-8")
    assert {name for name in PROVED if f"`{name}`" not in page} == set()
