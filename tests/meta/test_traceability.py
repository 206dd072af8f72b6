"""The equations cited in the code are those labelled in the docs and those covered by tests.

They are the paper's, 1 to 13; the tests are in tests/equations.
"""

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

import quasistatic_ref

PACKAGE = Path(quasistatic_ref.__file__).parent
EQUATIONS = Path(__file__).parents[1] / "equations"
PAPER = set(range(1, 14))
DOCS = Path(__file__).parents[2] / "docs"
NUMBER = r"(?:\(|:eq:`eq-)(\d+)[)`]"
LABEL = re.compile(r"^\$\$.*\$\$ \(eq-(\d+)\)$", re.MULTILINE)
CITATION = re.compile(rf"\bEqs?\.\s+{NUMBER}(?:(?:-|,\s+and\s+|,\s+|\s+and\s+){NUMBER})*")


def cited(text):
    """The equation numbers that a text cites as Eq. (N), Eqs. (N)-(M), Eqs. (N), (M) and (K)."""
    numbers = set()
    for found in CITATION.finditer(text):
        whole = found.group()
        numbers |= {int(n) for n in re.findall(NUMBER, whole)}
        for first, last in re.findall(rf"{NUMBER}-{NUMBER}", whole):
            numbers |= set(range(int(first), int(last) + 1))
    return numbers


def test_files():
    return {path: int(path.name[7:9]) for path in sorted(EQUATIONS.glob("test_eq*.py"))}


test_files.__test__ = False


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("# Eq. (8)", {8}),
        ("Eqs. (5)-(7): n~", {5, 6, 7}),
        ("Eqs. (1), (4), (10), (13).", {1, 4, 10, 13}),
        ("Eqs. (4) and (10): the pyramid (5)-(6)", {4, 10}),
        ("H, g of Eq. (13) and A, b of Eq. (8)", {8, 13}),
        ("Eqs. :eq:`eq-5`-:eq:`eq-7`, as a link", {5, 6, 7}),
        ("Eqs. :eq:`eq-1`, :eq:`eq-4`, :eq:`eq-13`.", {1, 4, 13}),
        ("residuals of\n    Eqs.\n    (9)-(12)", {9, 10, 11, 12}),
        ("f(3), Sect. (2), equation 4", set()),
    ],
)
def test_citations_are_read_as_a_person_reads_them(text, numbers):
    assert cited(text) == numbers


def test_every_number_cited_in_the_package_is_one_of_the_paper_s():
    for path in PACKAGE.rglob("*.py"):
        assert cited(path.read_text()) <= PAPER, path


def test_every_equation_of_the_paper_has_one_test_file():
    assert sorted(test_files().values()) == sorted(PAPER)


def test_every_equation_of_the_paper_is_cited_in_the_code():
    everywhere = set().union(*(cited(path.read_text()) for path in PACKAGE.rglob("*.py")))
    assert everywhere == PAPER


def test_every_equation_of_the_paper_is_labelled_once_and_in_order():
    # In order and in one page, because the site numbers equations as they come.
    labels = {
        path: [int(n) for n in LABEL.findall(path.read_text())] for path in DOCS.rglob("*.md")
    }
    assert [numbers for numbers in labels.values() if numbers] == [sorted(PAPER)]


def code_under(equations):
    """Each equation's number with the text up to the next one."""
    parts = LABEL.split(equations)[1:]
    return {int(n): text for n, text in zip(parts[::2], parts[1::2], strict=True)}


def test_under_each_equation_stand_its_code_and_its_test():
    under = code_under((DOCS / "theory" / "equations.md").read_text())
    # (2) and (3), (5) and (6) are one display and one function.
    shown = {n: under[n if n not in (2, 5) else n + 1] for n in PAPER}
    for path, number in test_files().items():
        header = ast.get_docstring(ast.parse(path.read_text()))
        module, name = re.search(r"Under test: ([\w.]+)\.(\w+)\.", header).groups()
        assert f"quasistatic_ref/{module.replace('.', '/')}.py" in shown[number], number
        assert re.search(rf":pyobject: {name}\b", shown[number]), number
        assert f"`tests/equations/{path.name}`" in shown[number], number


def test_each_file_cites_its_own_number_and_names_what_it_tests():
    for path, number in test_files().items():
        header = ast.get_docstring(ast.parse(path.read_text()))
        assert header is not None, path
        assert number in cited(header.split("\n")[0]), path
        under_test = re.search(r"Under test: ([\w.]+)\.(\w+)\.", header)
        assert under_test, path
        module, name = under_test.groups()
        assert hasattr(import_module(f"quasistatic_ref.{module}"), name), path
        assert name in path.read_text().replace(header, ""), path


def test_each_file_holds_at_least_one_test():
    for path in test_files():
        functions = [n for n in ast.parse(path.read_text()).body if isinstance(n, ast.FunctionDef)]
        assert any(f.name.startswith("test_") for f in functions), path
