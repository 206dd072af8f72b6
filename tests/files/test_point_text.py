"""Texts of points as people bring them: the points in them or a sentence, never another cloud."""

from itertools import product

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import InputError, ModelError
from quasistatic_ref.files.point_text import text_points
from tests.cases import refusal
from tests.closeness import assert_same
from tests.made import point_cloud, seen_points

POINTS = np.array([[0.04, 0.01, 0.02], [-0.04, 0.015, 0.021], [0.01, -0.03, 0.022], [2, 3, -5]])


def rows_of(first, separator="\t", line="{} {} {}"):
    """A first line, and the points below it."""
    lines = [line.format(*point, i=i) for i, point in enumerate(POINTS.tolist(), 1)]
    return "\n".join([first, *(each.replace(" ", separator) for each in lines)])


READ = {
    "a name with a blank": (rows_of("Point ID,X,Y,Z,Intensity", ",", "{i} {} {} {} 0.{i}"), None),
    "units and colours": (rows_of("X [m],Y [m],Z [m],R,G,B", ",", "{} {} {} 12 13 14"), "m"),
    "round brackets": (rows_of("x(mm);y (mm);z  ( MM )", ";"), "mm"),
    "units between blanks": (rows_of("X [cm]  Y [cm] Z [cm] time [s]", " ", "{} {} {} 3"), "cm"),
    "tabs part names with blanks": (rows_of("Point ID\tX\tY\tZ", "\t", "{i} {} {} {}"), None),
    "quoted": (rows_of('"x [in]","y [in]","z [in]","a, b"', ",", '"{}" "{}" "{}" "1, 2"'), "in"),
    "R": (rows_of('"","x","y","z"', ",", '"{i}" {} {} {}'), None),
    "R, with blanks": (rows_of('"id" "x" "y" "z"', " ", '"a{i}" {} {} {}'), None),
    "CloudCompare": (rows_of("//X Y Z R G B", " ", "{} {} {} 12 13 14"), None),
    "NumPy's comment": (rows_of("# scan 7\n# id x y z", " ", "9{i} {} {} {}"), None),
    "a comment in words": (rows_of("# x to the right, y back, z up", " "), None),
    "colours without names": (rows_of("4", " ", "{} {} {} 1 2 3"), None),
}
"""Texts of POINTS, and the unit that they name."""


@pytest.mark.parametrize("name", READ)
def test_columns_are_those_of_their_names(name):
    text, unit = READ[name]
    points, unit_of_names = text_points(text)
    assert_same(points, POINTS)
    assert unit_of_names == unit


COMMA = "line 1: has a decimal comma; write decimals with a point"
COUNTS = "line 1: has a number that counts the rows in the place of x; leave that"
WIDTH = "line 2: must have 3 columns, as the first row has"
REFUSED = {
    "decimal commas and blanks.xyz": ("0,04 0,01 0,02\n", COMMA),
    "decimal commas and semicolons.csv": ("0,04;0,01;0,02\n", COMMA),
    "decimal commas and tabs.txt": ("-0,04\t1,5e-3\t,02\n", COMMA),
    "quoted decimal commas.csv": ('"0,04","0,01","0,02"\n', COMMA),
    "decimal commas between commas.csv": ("0,04,0,01,0,02\n", "line 1: may have decimal commas"),
    "a column of zeros between them.csv": ("0,04,0,-0,02\n", "line 1: may have decimal commas"),
    "decimal commas below a name too many.csv": (
        "x,y,z,\n0,04 0,01 0,02\n", "line 2: must be separated by commas, as the rows above",
    ),
    "names of one column less.txt": ("x y z\n1 0.04 0.01 0.02\n", WIDTH),
    "quoted names of one column less.csv": ('"x","y","z"\n"1",0.04,0.01,0.02\n', WIDTH),
    "counted from 1.txt": ("1 0.04 0.01 0.02\n2 0.01 0.01 0.02\n", COUNTS),
    "counted from 0.csv": ("0,0.04,0.01,0.02\n1,nan,nan,nan\n", COUNTS),
    "counted from 500.csv": ('"500";0.04;0.01;0.02\n"501";0.4;1;2\n', COUNTS),
    "names that blanks part otherwise.txt": (
        "X Y Z Point ID\n1 0.04 0.01 0.02 7\n2 0.04 0.01 0.02 9\n", "line 2: has a number that",
    ),
    "rows that blanks part otherwise.txt": (
        "Point ID x y z my ID\nPoint 1 9 0.4 0.1 0.2 7\n", "line 2: must be a finite decimal",
    ),
    "a comment of other columns.txt": (
        "# id x y z\n7 0.04 0.01 0.02 255\n", "line 1: must name each of the 5 columns, or none",
    ),
    "names of another separator.csv": (
        "x,y,z\n1 2 3\n", "line 2: must be separated by commas, as the rows above it",
    ),
    "rows of another separator.csv": (
        "x;y;z\n0.04,0.01,0.02\n", "line 2: must be separated by semicolons, as the rows above",
    ),
    "another separator below.csv": (
        "0.1,0.2,0.3\n0.1;0.2;0.3\n", "line 2: must be separated by commas, as the rows above",
    ),
    "mixed separators.csv": ("0.1,0.2,0.3\n0.1;0.2,0.3,0.4\n", "line 2: must be"),
    "blanks among commas.csv": ("0.1 0.2,0.3,0.4\n", "line 1: must be a finite decimal number"),
    "a name twice.csv": ("X [m],x,y,z\n1,2,3,4\n", "line 1: must name the column x once"),
    "units in names.csv": ("X_mm,Y_mm,Z_mm\n1,2,3\n", "line 1: must be numbers, or names, among"),
    "two units.csv": ("x [m],y [m],z [mm]\n1,2,3\n", "line 1: must have one unit, behind each of"),
    "one unit.csv": ("x [m],y,z\n1,2,3\n", "line 1: must have one unit, behind each of x, y and z"),
    "another unit.csv": ("x [ft],y [ft],z [ft]\n1,2,3\n", "line 1: must have one of the units m, "),
    "millimetres.csv": ("x [mm],y [mm],z [mm]\n1,2,3\n", "unit: must be metres; `quasistatic-ref"),
    "a count of very many digits.pts": (5000 * "9" + "\n1 2 3\n", "line 1: must be three numbers"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_may_be_another_cloud_is_refused_by_line(tmp_path, name):
    text, words = REFUSED[name]
    (tmp_path / name).write_text(text)
    with refusal(ModelError, str(tmp_path / name), words):
        point_cloud(tmp_path / name)


HEADS = ("", "{}", "{} [mm]", '"{}"', "# {}")
SEPARATORS = (" ", "\t", ",", ";", ", ")
ROW_NAMES = ("", "{i}", '"{i}"', "p{i}", "Point {i}")
BEFORE = ((), ("Point ID",))
BEHIND = ((), ("Intensity",), ("R", "G", "B"), ("R", "Scan Angle", "Pt"))
NAMED_TOO = (True, False)
"""Whether the column of names of rows has a name itself."""
FORMS = list(product(HEADS, SEPARATORS, ".,", ROW_NAMES, NAMED_TOO, BEFORE, BEHIND))


def drawn_table(form, rng):
    """A table of three points in 3 to 8 columns as programs and people write it, and the points."""
    head, separator, decimal_mark, row_name, is_named_too, before, behind = form
    points = rng.uniform(-50, 50, (3, 3)).round(rng.integers(4))
    points[:, rng.integers(3)] *= rng.integers(2)
    names = [*before, *"XYZ", *behind]
    if row_name and is_named_too:
        names.insert(0, "row")
    is_comment = head.startswith("#")
    row_of_names = separator.join(head.removeprefix("# ").format(name) for name in names)
    lines = [f"# {row_of_names}" if is_comment else row_of_names] if head else []
    for i, point in enumerate(points.tolist(), start=rng.integers(2)):
        words = [row_name.format(i=i)] if row_name else []
        words += [str(rng.integers(100)) for _ in before]
        words += [f"{x:g}".replace(".", decimal_mark) for x in point]
        words += [str(rng.integers(256)) for _ in behind]
        lines.append(separator.join(words))
    return "\n".join(lines), points


def is_plain(form):
    """Whether any reader of such tables would take a form for what it is."""
    head, separator, decimal_mark, row_name, is_named_too, before, behind = form
    is_whole = head and head[0] != "#" and (is_named_too or not row_name)
    parts_blanks = separator != " " or "Point" not in row_name + " ".join([*before, *behind])
    return is_whole and decimal_mark == "." and parts_blanks and separator.strip()


@pytest.mark.parametrize("first", range(6))
def test_a_drawn_table_is_its_points_or_refused(first, rng):
    """Without names x, y and z stand first, but for names of rows."""
    outcomes = {"read": 0, "refused": 0}
    for form in FORMS[first::6]:
        if form[0] == "" and form[5]:
            continue
        text, points = drawn_table(form, rng)
        try:
            read, unit = text_points(text)
        except ModelError:
            assert not is_plain(form), text
            outcomes["refused"] += 1
        else:
            assert_same(read, points)
            assert unit == ("mm" if "mm" in form[0] else None)
            outcomes["read"] += 1
    assert min(outcomes.values()) > 50


def test_a_body_takes_the_unit_of_its_columns(tmp_path):
    """A box of 80 x 60 x 40 mm holds 192 cm^3; its corners and 300 points are on it."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (300, 3))
    points[np.arange(300), rng.integers(3, size=300)] = rng.choice([-1, 1], 300)
    points = np.concatenate([points, list(product((-1, 1), repeat=3))]) * [40, 30, 20]
    path = tmp_path / "box.csv"
    rows = "".join("{},{:.4f},{:.4f},{:.4f}\n".format(i, *row) for i, row in enumerate(points, 1))
    path.write_text("Point ID,X [mm],Y [mm],Z [mm]\n" + rows)
    assert seen_points(path).unit == "mm"
    for unit in (None, "mm"):
        made = qr.scanned_body(path, density=1000.0, unit=unit)
        assert made.mass == pytest.approx(0.192, rel=1e-12)
    with refusal(InputError, f"{path}: unit: must be mm, as the file names its columns"):
        qr.scanned_body(path, density=1000.0, unit="m")
