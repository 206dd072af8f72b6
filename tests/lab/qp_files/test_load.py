"""Programs in files of others, and the command ``qp``."""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pyarrow
import pytest
import qpsolvers
import scipy.sparse
from pyarrow import parquet
from scipy.io import savemat

import quasistatic_ref as qr
from quasistatic_ref.lab.qp_files.load import load_qp
from quasistatic_ref.lab.study.store import rows_read
from tests.helpers import one_sentence
from tests.pages import ROOT
from tests.processes import python

DATA = Path(__file__).parent / "data"
PROVED = {"HS21": -99.96, "HS35MOD": 0.25, "HS76": -4.681818181818182, "HS118": 664.82045,
          "DUAL3": 0.13575583686602126, "HS51": 0.0, "LIPMWALK0": None}  # fmt: skip


def program_of(name):
    (path,) = DATA.glob(f"{name}.*")
    (program,) = load_qp(path).values()
    return program


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
    (read,) = load_qp(tmp_path / "problem.npz").values()
    assert qr.exact_qp(read) == qr.exact_qp(problem)
    assert qr.exact_qp(read).x.tolist() == [0.5, 1.0]


def test_a_test_set_of_qpbenchmark_is_read(tmp_path):
    columns = {"name": ["one"], "P": [[2.0, 0.0, 0.0, 2.0]], "q": [[-2.0, -4.0]]}
    columns |= {"G": [[1.0, 1.0]], "h": [[2.0]], "A": [None], "b": [None]}
    parquet.write_table(pyarrow.table(columns), tmp_path / "set.parquet")
    programs = load_qp(tmp_path / "set.parquet")
    assert [*programs] == ["set/one"]
    assert qr.exact_qp(programs["set/one"]).x.tolist() == [0.5, 1.5]


EYE = scipy.sparse.csc_array(np.eye(2))
MAT = {"P": EYE, "q": [[-1.0], [-2.0]], "A": scipy.sparse.csc_array([[1.0, 1], [1, 0], [0, 1]]),
       "l": [[-np.inf], [-5], [-5]], "u": [[1.0], [5], [5]], "n": 2, "m": 3}  # fmt: skip


@pytest.mark.parametrize("q", [MAT["q"], scipy.sparse.csc_array(MAT["q"]), [[-1, -2]]])
def test_a_mat_file_may_have_a_constant_and_a_sparse_q(q, tmp_path):
    savemat(tmp_path / "one.mat", MAT | {"q": q, "r": 7.0, "unused": {"a": 1}})
    (program,) = load_qp(tmp_path / "one.mat").values()
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
    (".mat", {"P": scipy.sparse.eye_array(9000)}, "has 9000 variables and 3 rows; at most"),
    (".mat", {"P": "eye"}, "P: must be 1 x 1 real numbers"),
    (".mat", {"x_l": [0.0], "h_u": [1.0]}, "is a problem of another package"),
    (".json", '{"P": {"m": 2}, "q": [1.0]}', "is no file of ExactQP"),
    (".lp", "", "write the model as .qps"),
    (".mps", "", "rename it"),
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
    first, _, head, *rows = said.splitlines()
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
    rows = [line.split() for line in said.splitlines()[2:]]
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


LIGHT = """
import sys
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
