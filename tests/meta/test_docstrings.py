"""Every public name says what it is: shapes, units and errors, in its docstring."""

from pathlib import Path

import pytest

import quasistatic_ref
from tests.meta.docstrings import complaints, units_of_symbols

PACKAGE = Path(quasistatic_ref.__file__).parent
NOTATION = Path(__file__).parents[2] / "docs" / "conventions.md"
FILES = sorted(PACKAGE.rglob("*.py"))


@pytest.fixture(scope="module")
def symbols():
    return units_of_symbols(NOTATION.read_text())


def test_every_public_name_states_shapes_units_and_errors(symbols):
    every = [said for path in FILES for said in complaints(path, path.read_text(), symbols)]
    assert every == []
    assert len(FILES) > 100
