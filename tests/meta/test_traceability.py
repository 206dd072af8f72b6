"""Equations and results that code and docs cite have one definition and a test.

The equations are the paper's, 1 to 13, with tests in tests/equations. Our own results are (R1),
(R2), ...: a claim of `validate` cites it, which a test calls, or its test by random instances has
the name test_r7_... for (R7).
"""

import ast
import re

from quasistatic_ref.lab.claims.registry import CLAIMS
from tests.meta.remedies import assert_alike
from tests.pages import PACKAGE, ROOT

EQUATIONS = ROOT / "tests" / "equations"
PAPER = set(range(1, 14))
NUMBER = r"(?:\(|:eq:`eq-)(\d+)[)`]"
LABEL = re.compile(r"^\$\$.*\$\$ \(eq-(\d+)\)$", re.MULTILINE)
CITATION = re.compile(rf"\bEqs?\.\s+{NUMBER}(?:(?:-|,\s+and\s+|,\s+|\s+and\s+){NUMBER})*")
RESULT = re.compile(r"\(R(\d+)\)")
DEFINED = re.compile(r"\*\*\(R(\d+)\)")
RANDOM = re.compile(r"^def (test(?:_r\d+)+)_\w+\(.*?(?=^def |^@|\Z)", re.MULTILINE | re.DOTALL)
"""A test of a result, to the next function."""
PAGES = {path: path.read_text("utf-8") for path in (ROOT / "docs").rglob("*.md")}
RESULTS = sorted(int(n) for page in PAGES.values() for n in DEFINED.findall(page))
"""The numbers of those that are derived."""
UNDER_TEST = re.compile(r"Under test: ([\w.]+)\.(\w+)\.")


def cited_equations(text):
    """The equation numbers that a text cites as Eq. (N), Eqs. (N)-(M), Eqs. (N), (M) and (K)."""
    numbers = set()
    for found in CITATION.finditer(text):
        whole = found.group()
        numbers |= {int(n) for n in re.findall(NUMBER, whole)}
        for first, last in re.findall(rf"{NUMBER}-{NUMBER}", whole):
            numbers |= set(range(int(first), int(last) + 1))
    return numbers


def test_the_package_cites_every_equation_of_the_paper_and_no_other():
    cited = set().union(*(cited_equations(path.read_text()) for path in PACKAGE.rglob("*.py")))
    assert_alike(
        map(str, cited),
        map(str, PAPER),
        "Eq. ({}) is cited and is none of the paper: correct its number in the package",
        "Eq. ({}) is cited nowhere in the package: cite it where it is computed",
    )


def test_every_equation_of_the_paper_is_labelled_once_and_in_order():
    # In order and in one page, because the site numbers equations as they come.
    pages = (LABEL.findall(page) for page in PAGES.values())
    assert [[int(n) for n in numbers] for numbers in pages if numbers] == [sorted(PAPER)]


def test_under_each_equation_stand_its_code_and_its_test():
    parts = LABEL.split((ROOT / "docs" / "theory" / "equations.md").read_text())[1:]
    under = dict(zip(map(int, parts[::2]), parts[1::2], strict=True))
    files = sorted(EQUATIONS.glob("test_eq*.py"))
    assert [int(path.name[7:9]) for path in files] == sorted(PAPER)
    for path, number in zip(files, sorted(PAPER), strict=True):
        header = ast.get_docstring(ast.parse(path.read_text()))
        assert number in cited_equations(header.split("\n")[0]), path
        module, name = UNDER_TEST.search(header).groups()
        # (2) and (3), (5) and (6), (10) to (12) are one display and one function.
        shown = under[{2: 3, 5: 6, 10: 12, 11: 12}.get(number, number)]
        file = f"quasistatic_ref/{module.replace('.', '/')}.py"
        assert re.search(rf"<!-- code {file} {name}\b", shown), number
        assert f"`tests/equations/{path.name}`" in shown, number


def test_every_result_is_derived_once_and_cited_ones_are():
    files = (*PAGES, *PACKAGE.rglob("*.py"), *ROOT.glob("tests/**/*.py"))
    assert len({*RESULTS}) == len(RESULTS), "derive each result once"
    cited = {
        f"R{n} is cited in {path.relative_to(ROOT)} and derived nowhere: add **(R{n})** to"
        for path in files
        for n in RESULT.findall(path.read_text("utf-8"))
        if int(n) not in RESULTS
    }
    assert_alike(cited, (), "{} docs/derivations.md")


def test_every_result_has_a_claim_or_a_test_by_random_instances():
    claims = CLAIMS["Closed forms"].values()
    tested = {int(n) for claim in claims for n in RESULT.findall(claim.where)}
    uncited = {claim.name for claim in claims if not RESULT.search(claim.where)}
    assert_alike(uncited, (), "claim {} cites no result: add its (R..) to `where`")
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        for found in RANDOM.finditer(path.read_text("utf-8")):
            assert re.search(r"\b(rng|seed)\b", found[0]), (path, found[1])
            tested |= {int(n) for n in re.findall(r"_r(\d+)", found.group(1))}
    assert_alike(
        map(str, RESULTS),
        map(str, tested),
        "R{} has no test: name it in `where` of a claim, or write test_r{}_... with rng or seed",
        "R{} is tested and derived nowhere: add **(R{})** to docs/derivations.md",
    )
