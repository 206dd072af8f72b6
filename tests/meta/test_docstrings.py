"""Every public name says what it is: shapes, units and errors, in its docstring."""

import inspect

import pytest

import quasistatic_ref as qr
from tests.meta.docstrings import complaints, units_of_symbols
from tests.pages import PACKAGE, ROOT

NOTATION = [
    ROOT / "docs" / "conventions.md",
    PACKAGE / "shapes" / "__init__.py",
    PACKAGE / "lab" / "claims" / "__init__.py",
    PACKAGE / "exact" / "qp" / "__init__.py",
]
"""Tables of symbols with their units."""
FILES = sorted(PACKAGE.rglob("*.py"))
UNCHECKED = "constructor checks nothing."
OF_OTHERS = {"Exact", "Observer", "Recording"}
"""Whose constructors are CVXPY's, or take nothing."""


@pytest.fixture(scope="module")
def symbols():
    return units_of_symbols("\n".join(path.read_text("utf-8") for path in NOTATION))


@pytest.mark.long  # lint
def test_every_public_name_states_shapes_units_and_errors(symbols):
    every = [said for path in FILES for said in complaints(path, path.read_text(), symbols)]
    assert every == []
    assert len(FILES) > 100


def test_a_constructor_checks_its_arguments_or_says_that_it_does_not():
    """Each argument is an object of no use."""
    public = [getattr(qr, name) for name in {*qr.__all__} - OF_OTHERS]
    classes = [kind for kind in public if inspect.isclass(kind) and not inspect.isabstract(kind)]
    checking = [
        kind
        for kind in classes
        if UNCHECKED not in kind.__doc__ and not issubclass(kind, Exception)
    ]
    assert len(checking) > 20
    for kind in checking:
        with pytest.raises(qr.QuasistaticError):
            kind(**dict.fromkeys(inspect.signature(kind).parameters, object()))
