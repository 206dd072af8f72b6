"""``.qps`` files: decimals as they stand, conventions, and what is refused."""

import json
from fractions import Fraction

import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.qp_files.qps import qps_names
from tests.pages import ROOT

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


def answer(text, folder, name="model.qps"):
    path = folder / name
    path.write_text(text, "utf-8")
    return qr.exact_qp(qr.load_qp(path))


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


@pytest.mark.parametrize("name", ["model.mps", "MODEL.MPS", "model.SIF", "model.QPS"])
def test_a_text_in_this_format_has_one_of_several_names(name, tmp_path):
    assert answer(FILE, tmp_path, name) == answer(FILE, tmp_path)


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
    program = qr.load_qp(path)
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
        (("1.5", "9" * 900 + "e9"), "has more than 800 characters"),
        ((" UP bnd       x         20.0", " UP b x -1e999"), "UP x: is below 0 without a lower"),
        ((" UP bnd       x         20.0", " LO b x inf"), "LO x: must be a finite number, or inf"),
        ((" UP bnd       x         20.0", " UP b x -inf"), "UP x: must be a finite number, or inf"),
        (("ROWS\n", "ROWS\n L r1\n"), "r1: is declared twice"),
    ],
)
def test_files_in_which_readers_differ_or_that_none_solves_get_one_sentence(
    changes, sentence, tmp_path
):
    with pytest.raises(qr.InputError, match=r"model\.qps: ") as caught:
        answer(changed(*changes), tmp_path)
    assert sentence in str(caught.value)


SETS = {
    "RHS": ("RHS\n one r 1\n other r 5\n", 1.0),
    "RHS of no name": ("RHS\n r 1\n other r 5\n", 1.0),
    "RANGES": ("RHS\n s r 1\nRANGES\n one r 2\n other r 9\n", 1.0),
    "BOUNDS": ("RHS\n s r 1\nBOUNDS\n LO one x 3\n LO other x 7\n", 3.0),
}


@pytest.mark.parametrize("name", SETS)
def test_of_several_sets_the_first_is_taken_as_by_highs_and_that_is_said(name, tmp_path):
    """Min x with x >= r: the least x of the first sets."""
    lines, least = SETS[name]
    path = tmp_path / "sets.qps"
    path.write_text(f"NAME a\nROWS\n N o\n G r\nCOLUMNS\n x o 1 r 1\n{lines}ENDATA\n")
    section = name.split()[0]
    with pytest.warns(UserWarning, match=f"{section} has several sets: the first, .* is taken"):
        program = qr.load_qp(path)
    assert qr.exact_qp(program).obj == least


def test_an_upper_bound_may_be_infinite_and_so_may_a_lower_one(tmp_path):
    path = tmp_path / "free.qps"
    bounds = "BOUNDS\n LO b x -inf\n UP b x +inf\n"
    path.write_text(
        f"NAME a\nROWS\n N o\n G r\nCOLUMNS\n x o 1 r 1\nRHS\n s r -4\n{bounds}ENDATA\n"
    )
    program = qr.load_qp(path)
    assert qr.exact_qp(program).obj == -4.0


def test_rows_have_the_names_of_the_file():
    """A range gives two limits, the upper one first; an equation has its name alone."""
    text = changed(
        " L  r2\n", " L  r2\n E  r3\n", "y         obj       -2.0", "y  obj  -2.0  r3  1.0",
        "BOUNDS\n", "RANGES\n    rng  r1  3.0\nBOUNDS\n",
    )  # fmt: skip
    assert qps_names(text) == {
        "G[0]": "r1 <=", "G[1]": "r1 >=", "G[2]": "r2 <=", "A[0]": "r3",
        "lb[0]": "x >=", "ub[0]": "x <=", "lb[1]": "y >=", "ub[1]": "y <=",
    }  # fmt: skip


LINES = [*map(json.loads, (ROOT / "validation/optima/optima.jsonl").read_text().splitlines())]
BY_OTHERS = {
    ("maros-meszaros", "HS21"): -99.96,
    ("maros-meszaros", "HS76"): -4.681818181818182,
    ("maros-meszaros", "HS118"): 664.82045,
    ("netlib", "AFIRO"): -406659 / 875,
}


def test_each_line_of_the_table_says_one_number_twice():
    assert len({(line["set"], line["name"]) for line in LINES}) == len(LINES) > 100
    for line in LINES:
        if line["status"] == "optimal" and line["fraction"] is not None:
            assert float(Fraction(line["fraction"])) == line["objective"]
    by_name = {(line["set"], line["name"]): line for line in LINES}
    for key, objective in BY_OTHERS.items():
        assert by_name[key]["objective"] == pytest.approx(objective, rel=1e-14)
