"""``.qps`` files: decimals as they stand, conventions, and what is refused."""

from fractions import Fraction

import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.qp_files.load import load_qp

FILE = """NAME          TEST
* minimise 4 + 1.5 x - 2 y + 1/2 (8 x^2 + 2 * 2 x y + 10 y^2)
ROWS
 N  obj
 G  r1
 L  r2
COLUMNS
    x         r1        2.0            r2        -1.0
    x         obj       1.5
    y         r1        1.0            r2        2.0
    y         obj       -2.0
RHS
    rhs       obj       -4.0
    rhs       r1        2.0            r2        6.0
BOUNDS
 UP bnd       x         20.0
QUADOBJ
    x         x         8.0
    x         y         2.0
    y         y         10.0
ENDATA
"""


def answer(text, folder):
    path = folder / "model.qps"
    path.write_text(text, "utf-8")
    (program,) = load_qp(path).values()
    return qr.exact_qp(program)


def changed(*changes):
    text = FILE
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert old in text
        text = text.replace(old, new)
    return text


def test_a_file_is_the_program_that_its_comment_says(tmp_path):
    one = answer(FILE, tmp_path)
    P, rows = [[8, 2], [2, 10]], {"G": [[-2, -1], [-1, 2]], "h": [-2, 6]}
    two = qr.exact_qp(P, [1.5, -2], **rows, lb=[0, 0], ub=[20, "1e300"])
    assert (one.x.tolist(), one.obj) == (two.x.tolist(), two.obj + 4)
    assert one.obj == pytest.approx(8.371875, abs=1e-12)  # 4.371875 of the set's QPTEST
    assert qr.verify(one)


BOTH = "    x         y         2.0\n    y         x         2.0\n"
SAME = {
    "QMATRIX has both triangles": ("QUADOBJ", "QMATRIX", "    x         y         2.0\n", BOTH),
    "QSECTION has one": ("QUADOBJ", "QSECTION"),
    "entries twice are added up": ("obj       1.5", "obj       1.0\n    x         obj       0.5"),
    "quadratic entries, too": ("y         y         10.0", "y  y  4.0\n    y  y  6"),
    "exponents of Fortran": ("10.0\n", "1.0D1\n"),
    "comments at the end": ("8.0\n", "8.0 $ of x\n"),
    "no line end": ("ENDATA\n", "ENDATA"),
    "no names of sets": ("    rhs ", "    ", " bnd ", " "),
    "words of sections as names": ("r1", "RHS", "r2", "BOUNDS", "x ", "ROWS "),
    "other free rows": (" L  r2\n", " L  r2\n N  free\n", "obj       1.5", "obj 1.5 free 9"),
    "a sense": ("ROWS\n", "OBJSENSE\n    MIN\nROWS\n"),
    "another rhs": ("-4.0", "-4"),
    "names with blanks": ("r1 ", "r 1", "r1\n", "r 1\n"),
}


@pytest.mark.parametrize("name", SAME)
def test_another_form_of_the_same_program_is_read(name, tmp_path):
    assert answer(changed(*SAME[name]), tmp_path).x.tolist() == answer(FILE, tmp_path).x.tolist()


def test_decimals_are_decimals(tmp_path):
    text = changed("x         r1        2.0 ", "x         r1        0.55")
    assert answer(text, tmp_path).problem.exact["G"][0] == Fraction(-55, 100)


@pytest.mark.parametrize(
    ("row", "size", "low", "high"),
    [("E", 3, 2, 5), ("E", -3, -1, 2), ("L", 3, -1, 2), ("L", -3, -1, 2), ("G", -3, 2, 5)],
)
def test_a_range_goes_to_the_side_that_its_sign_says(row, size, low, high, tmp_path):
    for slope, end in ((1.0, low), (-1.0, high)):
        text = f"""NAME
ROWS
 N obj
 {row} r
COLUMNS
 x obj {slope} r 1
RHS
 b r 2
RANGES
 s r {size}
BOUNDS
 FR b x
ENDATA"""
        assert answer(text, tmp_path).x.tolist() == [end]


def test_max_negates_the_cost_and_its_constant(tmp_path):
    flipped = changed("ROWS\n", "OBJSENSE MAX\nROWS\n", "-4.0", "4.0", "obj       1.5",
        "obj -1.5", "obj       -2.0", "obj 2", "8.0\n", "-8.0\n", "y         2.0\n",
        "y         -2.0\n", "10.0\n", "-10.0\n")  # fmt: skip
    assert answer(flipped, tmp_path).obj == answer(FILE, tmp_path).obj


@pytest.mark.parametrize(
    ("lines", "low", "high"),
    [(" UP b x 0", 0, 0), (" MI b x\n UP b x -1", "-inf", -1), (" FX b x 3", 3, 3), ("", 0, "inf"),
     (" PL b x", 0, "inf"), (" FR b x", "-inf", "inf"), (" LO b x -inf", "-inf", "inf")],
)  # fmt: skip
def test_bounds_are_those_of_the_format(lines, low, high, tmp_path):
    path = tmp_path / "model.qps"
    path.write_text(f"NAME\nROWS\n N o\nCOLUMNS\n x o 1\nBOUNDS\n{lines}\nENDATA\n")
    (program,) = load_qp(path).values()
    assert (program.lb[0], program.ub[0]) == (float(low), float(high))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ((" UP bnd       x         20.0", " UP b x -1"), "UP x: is below 0 without a lower bound"),
        ((" UP ", " BV "), "line 16, BV: is a bound of whole or semi-continuous"),
        ((" UP ", " SC "), "line 16, SC: is a bound of whole or semi-continuous"),
        (
            ("COLUMNS\n", "COLUMNS\n M 'MARKER' 'INTORG'\n"),
            "line 8, M: begins or ends whole numbers",
        ),
        (("ROWS", "GROUPS"), "line 3, GROUPS: is in CUTEst's SIF language"),
        (("ENDATA", "QMATRIX\n x x 1\nENDATA"), "QMATRIX: stands beside QUADOBJ"),
        (("    x         y         2.0\n", BOTH), "QUADOBJ: has both triangles at x, y"),
        (("QUADOBJ", "QMATRIX"), "P: is one triangle, the upper one"),
        (("ENDATA\n", ""), "ends without ENDATA"),
        (("8.0", "eight"), "line 18: must be a number"),
        (("r1        2.0 ", "r9        2.0 "), "r9: is declared in no section"),
        (("20.0", "20.0 30"), "line 16, UP: has too many fields"),
        (("1.5", "1e999"), "is beyond the range of float64"),
    ],
)
def test_files_in_which_readers_differ_or_that_none_solves_get_one_sentence(
    changes, sentence, tmp_path
):
    with pytest.raises(qr.InputError, match=r"model\.qps: ") as caught:
        answer(changed(*changes), tmp_path)
    assert sentence in str(caught.value)
