"""Every public name says what it is: shapes, units and errors, in its docstring."""

import pytest

from tests.meta.docstrings import complaints, units_of_symbols
from tests.pages import PACKAGE, ROOT

NOTATION = [
    ROOT / "docs" / "conventions.md",
    PACKAGE / "shapes" / "__init__.py",
    PACKAGE / "lab" / "claims" / "__init__.py",
    PACKAGE / "optional" / "qp" / "__init__.py",
]
"""Tables of symbols with their units."""
FILES = sorted(PACKAGE.rglob("*.py"))


@pytest.fixture(scope="module")
def symbols():
    return units_of_symbols("\n".join(path.read_text("utf-8") for path in NOTATION))


@pytest.mark.long  # lint
def test_every_public_name_states_shapes_units_and_errors(symbols):
    every = [said for path in FILES for said in complaints(path, path.read_text(), symbols)]
    assert every == []
    assert len(FILES) > 100
