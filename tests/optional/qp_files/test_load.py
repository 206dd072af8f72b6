"""Programs in files of others, and the command ``qp``."""

import json
import os
import re
import sys
from itertools import chain, repeat
from pathlib import Path

import numpy as np
import pyarrow
import pytest
import qpsolvers
import scipy.sparse
from pyarrow import parquet
from scipy.io import savemat

import quasistatic_ref as qr
from quasistatic_ref.exact import time_limit
from quasistatic_ref.lab.study.store import rows_read
from tests.helpers import one_sentence
from tests.pages import ROOT
from tests.processes import python

DATA = Path(__file__).parent / "data"
PROVED = {"HS21": -99.96, "HS35MOD": 0.25, "HS76": -4.681818181818182, "HS118": 664.82045,
          "DUAL3": 0.13575583686602126, "HS51": 0.0, "LIPMWALK0": None}  # fmt: skip


def program_of(name):
    (path,) = DATA.glob(f"{name}.*")
    return qr.load_qp(path)


@pytest.mark.parametrize("name", PROVED)
def test_public_programs_are_proved(name):
    answer = qr.exact_qp(program_of(name))
    assert qr.verify(answer)
    if PROVED[name] is not None:
        assert answer.obj == pytest.approx(PROVED[name], rel=1e-14, abs=0)


def test_a_public_program_whose_row_rounding_has_emptied_has_no_solution():
    with pytest.raises(qr.QPInfeasible, match=r"G\[0\] asks for 0 <= -2.78e-17") as caught:
        qr.exact_qp(program_of("LIPMWALK10"))
    assert qr.verify(caught.value)
    assert caught.value.rows == ("G[0]",)


def test_a_file_of_qpsolvers_is_read_and_what_is_missing_there_is_none(tmp_path):
    problem = qpsolvers.Problem(np.eye(2), -np.ones(2), ub=np.array([0.5, 2.0]))
    problem.save(str(tmp_path / "problem.npz"))
    read = qr.load_qp(tmp_path / "problem.npz")
    assert qr.exact_qp(read) == qr.exact_qp(problem)
    assert qr.exact_qp(read).x.tolist() == [0.5, 1.0]


def test_a_test_set_of_qpbenchmark_is_read(tmp_path):
    columns = {"name": ["one"], "P": [[2.0, 0.0, 0.0, 2.0]], "q": [[-2.0, -4.0]]}
    columns |= {"G": [[1.0, 1.0]], "h": [[2.0]], "A": [None], "b": [None]}
    parquet.write_table(pyarrow.table(columns), tmp_path / "set.parquet")
    path = tmp_path / "set.parquet"
    assert qr.exact_qp(qr.load_qp(path)).x.tolist() == [0.5, 1.5]
    both = {key: 2 * value for key, value in columns.items()} | {"name": ["one", "two"]}
    both["q"] = [[-2.0, -4.0], [-4.0, -2.0]]
    parquet.write_table(pyarrow.table(both), path)
    assert qr.exact_qp(qr.load_qp(path, "two")).x.tolist() == [1.5, 0.5]
    with pytest.raises(qr.InputError, match=r"set.parquet: holds several programs; give .* two"):
        qr.load_qp(path)
    with pytest.raises(qr.InputError, match=r"set.parquet: holds no program 'tow'; did you mean"):
        qr.load_qp(path, "tow")
    with pytest.raises(qr.InputError, match=r"^name: must be the name of a program"):
        qr.load_qp(path, 2)


EYE = scipy.sparse.csc_array(np.eye(2))
MAT = {"P": EYE, "q": [[-1.0], [-2.0]], "A": scipy.sparse.csc_array([[1.0, 1], [1, 0], [0, 1]]),
       "l": [[-np.inf], [-5], [-5]], "u": [[1.0], [5], [5]], "n": 2, "m": 3}  # fmt: skip


@pytest.mark.parametrize("q", [MAT["q"], scipy.sparse.csc_array(MAT["q"]), [[-1, -2]]])
def test_a_mat_file_may_have_a_constant_and_a_sparse_q(q, tmp_path):
    savemat(tmp_path / "one.mat", MAT | {"q": q, "r": 7.0, "unused": {"a": 1}})
    program = qr.load_qp(tmp_path / "one.mat")
    answer = qr.exact_qp(program)
    assert (answer.x.tolist(), answer.obj) == ([0.0, 1.0], 5.5)
    assert qr.verify(answer)


def spoilt(matrix):
    """A sparse matrix whose indices lie outside of it."""
    wrong = matrix.copy()
    wrong.indices = wrong.indices + 1000
    return wrong


class Fatal:
    """A pickle that would end the test."""

    def __reduce__(self):
        return sys.exit, (1,)


def pickled(entry):
    """An archive of NumPy's with any object in it."""
    G = np.empty((), dtype=object)
    G[()] = entry
    return {"G": G}


ROW = {"name": "a", "P": [1.0, 0, 0, 1], "q": [0.0, 0], "G": [1.0, 1], "h": [1.0]}


def written(path, content):
    """Write a text, or what is changed in a good file; of a table also several rows."""
    if isinstance(content, str):
        path.write_text(content)
    elif path.suffix == ".npz":
        np.savez(path, **{"P": np.eye(2), "q": np.ones(2), "h": np.array(None)} | content)
    elif path.suffix == ".mat":
        savemat(path, MAT | content, do_compression=True)
    else:
        rows = content if isinstance(content, list) else [content]
        table = pyarrow.Table.from_pylist([ROW | row for row in rows] or [ROW])
        parquet.write_table(table.slice(0, len(rows)), path)


BAD = [
    # how a file's name ends, what is in it, what is said
    *(
        (".npz", pickled(entry), r"G.npy is a pickle, .*; save a dense")  # which is never opened
        for entry in (Fatal(), "text", scipy.sparse.csc_matrix(np.eye(2)), [None])
    ),
    (".mat", {"l": [[0.0]] * 2}, "l: must be 3 real numbers"),
    (".mat", {"q": [[3j], [0]]}, "q: must be 2 real numbers"),
    (".mat", {"P": np.eye(3)[:2]}, "P: must be 2 x 2 real numbers"),
    (".mat", {"P": spoilt(EYE)}, "is not P of a problem, or is spoilt"),
    (".mat", {"A": scipy.sparse.csc_array((3, 2))}, "A: must end in a unit matrix"),
    (".mat", {"P": scipy.sparse.eye_array(9000)}, "has 9000 variables and 3 rows; of a quadratic"),
    (".mat", {"P": "eye"}, "P: must be 1 x 1 real numbers"),
    (".mat", {"x_l": [0.0], "h_u": [1.0]}, "is a problem of another package"),
    (".json", '{"P": {"m": 2}, "q": [1.0]}', "is no file of ExactQP"),
    (".lp", "", "write the model as .qps"),
    (".mps", "", "ends without ENDATA"),
    (".parquet", {"P": [1.0, 0, 1]}, r"row 0, P: must be 2 x 2 numbers, row after row \(got 3\)"),
    (".parquet", {"G": [1.0]}, "row 0, G: must be 1 x 2 numbers"),
    (".parquet", {"q": []}, "row 0, "),
    (".parquet", {"q": None}, "row 0, "),
    (".parquet", {"q": 1.5}, "row 0, q: must be a list of numbers"),
    (".parquet", {"P": [[1.0, 0.0], [0.0]]}, "row 0, P: must be 2 x 2 numbers"),
    (".parquet", {"q": ["a", "b"]}, "row 0, q: must be numbers"),
    (".parquet", [{}, {"q": [1.0, 1.0]}], "row 1, name: must be a text that no other row has"),
    (".parquet", {"name": 3}, "row 0, name: must be a text"),
    (".parquet", [], "holds no program"),
    *(
        (end, "nothing of the kind", "")
        for end in (".npz", ".mat", ".parquet", ".json", ".txt", ".qps")
    ),
]  # fmt: skip


@pytest.mark.parametrize(("suffix", "content", "sentence"), BAD)
def test_a_file_that_is_none_or_is_not_consistent_gets_one_sentence(
    suffix, content, sentence, tmp_path, cli
):
    path = tmp_path / f"one{suffix}"
    written(path, content)
    said = one_sentence(cli("qp", path, status=2).err)
    assert re.search(f"one{suffix}: .*{sentence}", said)


@pytest.mark.parametrize("suffix", [".mat", ".parquet", ".qps"])
def test_a_file_that_is_not_there_and_a_pipe_are_refused(suffix, tmp_path, cli):
    path = tmp_path / f"one{suffix}"
    assert "no such file" in one_sentence(cli("qp", path, status=2).err)
    os.mkfifo(path)
    assert "it is a device or a pipe" in one_sentence(cli("qp", path, status=2).err)


def test_a_name_reaches_the_terminal_without_its_control_characters(tmp_path, cli):
    written(tmp_path / "set.parquet", {"name": "\x1b[31m red \n=1+1"})
    said = cli("qp", tmp_path / "set.parquet").out
    assert "\x1b" not in said
    assert len(said.splitlines()) == 1


@pytest.mark.parametrize(("suffix", "package"), [(".mat", "scipy"), (".parquet", "pyarrow")])
def test_a_package_that_is_missing_is_named(suffix, package, tmp_path, cli, monkeypatch):
    monkeypatch.setitem(sys.modules, {"scipy": "scipy.io"}.get(package, "pyarrow.parquet"), None)
    path = tmp_path / f"file{suffix}"
    path.write_text("")
    assert f"pip install {package}" in one_sentence(cli("qp", path, status=2).err)


def test_the_command_proves_saves_and_grades(tmp_path, cli):
    answer = tmp_path / "answer.json"
    said = cli("qp", DATA / "DUAL3.mat", "-o", answer, "--solvers clarabel daqp").out
    first, _, units, head, *rows = said.splitlines()
    assert units.startswith("solvers get the file's numbers; ")
    assert first.startswith("DUAL3: proved: objective 0.1357558368660212")
    assert "active: A[0], lb[60]," in first
    columns = "solver accuracy says primal dual gap reached digits seconds"
    assert head.split() == columns.split()
    words = [row.split() for row in rows]
    accuracies = ("-", "1e-09")
    solvers = "qpsolvers:clarabel", "qpsolvers:daqp"
    asked = [(name, accuracy) for name in solvers for accuracy in accuracies]
    assert [tuple(line[:3]) for line in words] == [(*one, "solved") for one in asked]
    digits = {tuple(line[:2]): float(line[-2]) for line in words}
    assert digits["qpsolvers:clarabel", "1e-09"] < 8 < digits["qpsolvers:daqp", "1e-09"]
    assert "verified" in cli("verify", answer).out
    assert cli("qp", answer).out.splitlines()[0][8:] == first[7:]


LIGHT_COSTS = {
    # 1e-6 (x^2 + y^2) / 2 - 1e-6 (x - y), x - y <= 1: (0.5, -0.5)
    "light": (np.eye(2) * 1e-6, [-1e-6, 1e-6], [[1.0, -1.0]], [1.0]),
    "heavy": (np.eye(2) * 1e6, [-1e6, 1e6], [[1.0, -1.0]], [1.0]),
    "long": (np.eye(2), [-1e5, 1e5], [[1.0, -1.0]], [1e5]),
}


@pytest.mark.shared
@pytest.mark.parametrize("name", LIGHT_COSTS)
def test_the_command_grades_the_program_of_the_file_and_natural_units_if_asked(name, tmp_path, cli):
    """Digits are those of the user's own call; only in natural units are the three alike."""
    P, q, G, h = LIGHT_COSTS[name]
    path = tmp_path / f"{name}.npz"
    np.savez(path, P=P, q=q, G=G, h=h)
    as_sparse = map(scipy.sparse.csc_matrix, (P, np.array(G)))
    x = qpsolvers.solve_qp(
        next(as_sparse), np.array(q), next(as_sparse), np.array(h), solver="clarabel"
    )
    digits = qr.exact_qp(P, q, G, h).digits(x)
    for units, words in (("raw", "the file's numbers"), ("natural", "in natural units, in which")):
        option = "" if units == "raw" else "--units natural"
        said = cli("qp", path, "--solvers clarabel", option).out
        assert words in said.splitlines()[1]
        own = float(said.splitlines()[3].split()[-2])
        assert own == pytest.approx(digits, abs=0.051) or units == "natural"


def test_the_command_says_that_there_is_no_solution(tmp_path, cli):
    proof = tmp_path / "proof.json"
    said = cli("qp", DATA / "LIPMWALK10.npz", "-o", proof, status=3).out
    assert "has no solution: G[0] asks for 0 <= -2.78e-17" in said
    assert "verified" in cli("verify", proof).out
    proof.write_text(proof.read_text().replace('"G[0]": "1"', '"G[0]": "-1"'))
    assert "refuted: the factor of G[0] is negative" in cli("verify", proof, status=1).out


@pytest.mark.long  # two solvers that load libraries, as in the test before
def test_solvers_are_graded_where_p_is_singular_and_not_where_there_is_no_optimum(tmp_path, cli):
    said = cli("qp", DATA / "HS51.mat", "--solvers qpsolvers:clarabel cvxpy:clarabel").out
    rows = [line.split() for line in said.splitlines()[3:]]
    assert [row[0] for row in rows] == ["qpsolvers:clarabel"] * 2 + ["cvxpy:clarabel"] * 2
    assert min(float(row[-2]) for row in rows) > 6
    (tmp_path / "endless.qps").write_text("NAME\nROWS\n N o\nCOLUMNS\n x o -1\nENDATA\n")
    said = cli("qp", tmp_path / "endless.qps", "--solvers clarabel", status=3).out
    assert said == "endless: the cost falls without end along x_0 (proved without rounding)\n"
    assert "no program with an optimum" in one_sentence(cli("qp", tmp_path, status=2).err)


def test_a_folder_is_a_study_of_what_can_be_proved(tmp_path, cli):
    folder = tmp_path / "programs"
    folder.mkdir()
    for name in ("HS21.mat", "LIPMWALK10.npz", "README.md"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    (folder / "bad.json").write_text("{}")
    out = tmp_path / "study"
    said = cli("qp", folder, "--out", out, "--solvers clarabel", "--quiet").out
    assert "bad.json: left out: " in said
    rows = {(row.problem, row.setting): row for row in rows_read(out)}
    assert {*rows} == {(name, s) for name in ("HS21", "LIPMWALK10") for s in ("default", "high")}
    assert rows["HS21", "high"].digits > 6
    emptied = rows["LIPMWALK10", "high"]
    assert (emptied.feasible, emptied.digits, emptied.says) == (False, None, "solved")
    assert "summary.md" in cli("study report", out, "--out", tmp_path / "page").out
    table = (tmp_path / "page" / "summary.md").read_text().partition("## Who")[0].splitlines()
    head, _, clarabel, _ = [line.strip("| ").split(" | ") for line in table if line[:1] == "|"]
    counts = dict(zip(head, clarabel, strict=True))
    assert int(counts["solved, no solution"]) == 1  # a false one, without an accuracy


@pytest.fixture
def slow_start(monkeypatch):
    """What begins first meets its limit of ten minutes; the clock stands still from then on."""

    def begin():
        clock = chain([0.0], repeat(601.0))
        monkeypatch.setattr(time_limit, "monotonic", lambda: next(clock))

    return begin


def test_a_program_that_takes_too_long_is_left_out(tmp_path, cli, slow_start):
    """DUAL3 comes first and ends; a folder goes on."""
    folder = tmp_path / "programs"
    folder.mkdir()
    for name in ("HS21.mat", "DUAL3.mat"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    slow_start()
    words = "--solvers clarabel --quiet --seconds 600"
    said = cli("qp", folder, "--out", tmp_path / "study", words)
    assert "DUAL3: not ended in 600 s" in said.out
    assert {row.problem for row in rows_read(tmp_path / "study")} == {"HS21"}
    slow_start()
    options = ["--seconds 600 --solvers clarabel -o", tmp_path / "answer.json"]
    assert cli("qp", DATA / "DUAL3.mat", *options, status=3).out == "DUAL3: not ended in 600 s\n"
    assert not (tmp_path / "answer.json").exists()
    assert "proved" in cli("qp", DATA / "DUAL3.mat", "--seconds 600").out


LIGHT = """
import sys
from itertools import chain, repeat
sys.modules |= dict.fromkeys(("cvxpy", "scipy", "tqdm", "pinocchio", "coal", "matplotlib"))
from quasistatic_ref.cli.main import main, parsed, status
for command in sys.argv[1:]:
    outcome = status(parsed(command.split()))
sys.exit(outcome)
"""


def test_a_light_installation_does_its_own_and_says_what_else_is_missing():
    program = f"qp {(DATA / 'LIPMWALK0.npz').relative_to(ROOT)}"
    python("-c", LIGHT, program)
    others = {f"{program} --solvers clarabel": "scipy", "figures": "matplotlib"}
    others |= {"run bunny_grasp": "pinocchio"}
    said = python("-c", LIGHT, *others, status=2).stderr.splitlines()
    for missing, sentence in zip(others.values(), said, strict=True):
        assert f"this needs {missing}, which is not installed here" in sentence


def test_what_equal_numbers_unpack_to_is_counted_before_it_is_unpacked(tmp_path):
    """With dictionaries, as by default, 1.2 kB stand for 160 MB: the file is refused."""
    N = 17 * 2**20
    zeros = pyarrow.ListArray.from_arrays(
        pyarrow.array([0, N], pyarrow.int32()), pyarrow.array(np.zeros(N))
    )
    path = tmp_path / "zeros.parquet"
    table = pyarrow.table({"name": ["a"], "P": zeros, "q": [[0.0, 0.0]]})
    parquet.write_table(table, path, compression="none")
    assert path.stat().st_size < 2000
    with pytest.raises(qr.InputError, match="holds more numbers than are read"):
        qr.load_qp(path)


def test_a_constant_of_one_entry_is_a_number_and_a_list_is_refused(tmp_path):
    np.savez(tmp_path / "one.npz", P=np.eye(2), q=np.ones(2), constant=np.array([1.5]))
    program = qr.load_qp(tmp_path / "one.npz")
    assert qr.exact_qp(program).obj == -1.0 + 1.5
    path = qr.exact_qp(np.eye(2), [1.0, 1.0]).save(tmp_path / "list.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | {"constant": [1.0, 2.0]}))
    with pytest.raises(qr.InputError, match="constant: must be one number"):
        qr.load_qp(path)
    np.savez(tmp_path / "two.npz", P=np.eye(2), q=np.ones(2), constant=np.array([1.5, 2.0]))
    with pytest.raises(qr.InputError, match="constant: must be one number"):
        qr.load_qp(tmp_path / "two.npz")
