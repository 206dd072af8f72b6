"""The table of optima of public programs: made, and judged by the checker in one file."""

import json

import pytest

from validation import check_solution as checker
from validation.make import optima

TEXT = """NAME          TEST
ROWS
 N  cost
 G  low
 L  high
 E  sum
 E  band
COLUMNS
    x  cost  1.5  low  2.0
    x  high  -1.0  sum  1.0
    y  cost  -2.0  low  1.0
    y  high  2.0  sum  .1
    z  sum  -3.D-1  band  1.0
    w  band  1  cost  -.7
    v  cost  -5  sum  -.1
RHS
    rhs  cost  -4.0
    rhs  low  2.0  high  6.0
    rhs  sum  0.3
    rhs  band  1
    other  low  9
RANGES
    rng  low  3.0
    rng  band  -0.5
BOUNDS
 UP bnd  x  20.0
 MI bnd  z
 UP bnd  w  0.7
 FX bnd  v  2
 FR other  x
QUADOBJ
    x  x  8.0
    x  y  2.0
    y  y  10.0
ENDATA
"""
LINEAR = TEXT.partition("QUADOBJ")[0] + "ENDATA\n"
BLANKS = """NAME          NAMES WITH BLANKS
ROWS
 N  COST
 G  ROW 1
COLUMNS
    X 1       COST             1.0     ROW 1            3.0
RHS
    RHS       ROW 1            1.0
ENDATA
"""
PROGRAMS = {"QUADRATIC": TEXT, "LINEAR": LINEAR, "BLANKS": BLANKS}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with programs, and their table in a folder below."""
    folder = tmp_path_factory.mktemp("optima")
    (folder / "table").mkdir()
    for name, text in PROGRAMS.items():
        (folder / f"{name}.qps").write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(optima, "OPTIMA", folder / "table" / "optima.jsonl")
        assert optima.main("own", folder) == 0
    return folder


def judged(folder, name, table, capsys):
    """The exit status of the checker, and what it prints last."""
    status = checker.main(str(folder / f"{name}.qps"), str(table))
    return status, capsys.readouterr().out.splitlines()[-1]


@pytest.mark.filterwarnings("ignore:.* has several sets")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_line_and_its_answer_hold_by_substitution(name, made, capsys):
    table = made / "table" / "optima.jsonl"
    assert judged(made, name, table, capsys) == (0, "fraction: holds")


def test_the_optimum_of_a_bound_and_a_row_is_that_by_hand(made):
    """Of x 1 the least with 3 x 1 >= 1, at the row's multiplier 1 / 3."""
    answer = json.loads((made / "table" / "own" / "BLANKS.json").read_text())
    assert answer == {"x": {"X 1": "1/3"}, "multipliers": {"ROW 1 >=": "1/3"}}


FORGED = {
    "x moved": ("x", lambda v: f"{v}1", "FAILS"),
    "x left out": ("x", None, "FAILS"),
    "a multiplier grown": ("multipliers", lambda v: f"{v}1", "balance the cost: FAILS"),
    "a multiplier left out": ("multipliers", None, "balance the cost: FAILS"),
    "fraction": ("fraction", lambda v: f"{v}1", "fraction: FAILS"),
    "objective": ("objective", lambda v: v + 1e-9, "objective: FAILS"),
    "active": ("active", lambda v: v[1:], "of active rows: FAILS"),
    "another active row": ("active", lambda v: [*v, "high <="], "active rows bear: FAILS"),
    "no such row": ("active", lambda v: [*v, "none"], "the file does not have"),
    "the status": ("status", lambda v: "infeasible", "of which nothing is kept"),
    "the hash": ("sha256", lambda v: v[::-1], "has the hash of this file"),
}


@pytest.mark.parametrize("forged", FORGED)
def test_a_forged_line_or_answer_is_refused(forged, made, tmp_path, capsys):
    key, change, reason = FORGED[forged]
    lines = map(json.loads, (made / "table" / "optima.jsonl").read_text().splitlines())
    (line,) = (line for line in lines if line["name"] == "QUADRATIC")
    answer = json.loads((made / "table" / "own" / "QUADRATIC.json").read_text())
    if key in line:
        line[key] = change(line[key])
    else:
        name = next(iter(answer[key]))
        value = answer[key].pop(name)
        if change is not None:
            answer[key][name] = change(value)
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "QUADRATIC.json").write_text(json.dumps(answer))
    (tmp_path / "optima.jsonl").write_text(json.dumps(line) + "\n")
    status, said = judged(made, "QUADRATIC", tmp_path / "optima.jsonl", capsys)
    assert status == (1 if "FAILS" in reason else 2)
    assert reason in said
