"""Every public name says what it is: shapes, units and errors, in its docstring."""

from pathlib import Path

import pytest

import quasistatic_ref
from tests.meta.docstrings import complaints, units_of_symbols

PACKAGE = Path(quasistatic_ref.__file__).parent
NOTATION = Path(__file__).parents[2] / "docs" / "theory" / "notation.md"
FILES = sorted(PACKAGE.rglob("*.py"))


@pytest.fixture(scope="module")
def symbols():
    return units_of_symbols(NOTATION.read_text())


def test_every_public_name_states_shapes_units_and_errors(symbols):
    every = [said for path in FILES for said in complaints(path, path.read_text(), symbols)]
    assert every == []
    assert len(FILES) > 100


GOOD = '''
def spread(points: Array, h: float, factor: float, path: Path) -> Array:
    """Points moved apart, shape (N, 3).

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        [m].
    h : float
    factor : float
        By how much [-].
    path : Path

    Raises
    ------
    InputError
        If there are none.
    """
    raise InputError("none")
'''
FIELDS = '''
class Ball:
    """A ball.

    Parameters
    ----------
    centre : ndarray, shape (3,)
        [m].
    """

    centre: Array
'''
PLANTED = {
    "no docstring": ("\"\"\"A ball", "f\"\"\"A ball", FIELDS, "has no docstring"),
    "no shape of an argument": (
        "points : ndarray, shape (N, 3)", "points : ndarray", GOOD, "points without its shape",
    ),
    "no unit of a number": ("By how much [-]", "By how much", GOOD, "factor without its unit"),
    "no shape of the result": ("apart, shape (N, 3)", "apart", GOOD, "no shape of what is"),
    "an error left out": (
        "    InputError\n", "    OtherError\n", GOOD, "does not say when it raises InputError",
    ),
    "a field left out": ("centre : nd", "middle : nd", FIELDS, "centre is not documented"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "source", "said"), PLANTED.values(), ids=PLANTED)
def test_a_planted_gap_is_found(old, new, source, said):
    found = list(complaints("f.py", source.replace(old, new), {"h"}))
    assert any(said in complaint for complaint in found), found
