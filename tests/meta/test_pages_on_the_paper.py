"""Each row of the page on the paper ends with evidence that exists: a test, or a claim."""

import ast
import re

from quasistatic_ref.lab.claims.registry import BY_NAME
from tests.meta.remedies import assert_none
from tests.pages import ROOT

THEORY = ROOT / "docs" / "theory"
TESTS = ROOT / "tests"
PAGE = re.sub(r"^```.*?^```$", "", (THEORY / "errata.md").read_text("utf-8"), flags=re.M | re.S)
NAMED = re.compile(r"`([^`]+)`")
LINKED = re.compile(r"\]\(\.\./\.\./tests/([\w/]+\.py)\)")
LIST = r"((?:`\w+`(?:, | and )?)+)"


def listed_names(word, text):
    """Names that follow a word: claim `a`; claims `a`, `b` and `c`."""
    runs = re.findall(rf"\b{word}s? {LIST}", text)
    return [name for run in runs for name in NAMED.findall(run)]


def shown_errata(path):
    """The test functions of a file that show an erratum."""
    functions = [n for n in ast.parse(path.read_text()).body if isinstance(n, ast.FunctionDef)]
    return {f.name for f in functions if f.name.startswith("test_erratum_")}


def evidence(text):
    """Files of tests that a text links and that exist, and claims that it names."""
    claims = [name for name in listed_names("claim", text) if name in BY_NAME]
    return claims + [file for file in LINKED.findall(text) if (TESTS / file).is_file()]


def rows(markdown):
    """The rows of all tables, without their heads and rules."""
    tables = re.findall(r"(?:^\|.*\n)+", markdown, re.MULTILINE)
    return [row for table in tables for row in table.splitlines()[2:]]


def test_every_row_ends_with_a_test_or_a_claim():
    found = rows(PAGE)
    assert len(found) > 20
    assert [row for row in found if not evidence(row.rstrip("| ").rpartition(" | ")[2])] == []


def test_claims_and_files_that_show_errata_are_on_the_page_and_its_links_are_there():
    files = [path for path in TESTS.rglob("test_eq*.py") if shown_errata(path)]
    about = [name for name, claim in BY_NAME.items() if claim.where.startswith("the paper")]
    assert files
    assert about
    links = LINKED.findall(PAGE)
    page = "docs/theory/errata.md"
    assert_none(
        [
            (
                links,
                evidence(PAGE),
                f"{page} links tests/{{}}, which is not there: link a file of tests",
            ),
            (
                [file.relative_to(TESTS).as_posix() for file in files],
                links,
                f"tests/{{}} shows an erratum that is not told: add a row to {page}",
            ),
            (
                about,
                listed_names("claim", PAGE),
                f"The claim {{}} is about the paper: name it in {page}",
            ),
        ]
    )
