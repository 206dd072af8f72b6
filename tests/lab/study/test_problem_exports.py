"""A set in the formats of others: each read back by its own reader, and qpbenchmark's command."""

import csv
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.sparse import csr_matrix

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.study.problems import exports


@pytest.fixture
def few(members):
    """Some problems of each kind: rows, rows without a solution, cones, sparse matrices."""
    names = ("wedge", "infeasible", "ellipsoid", "sparse")
    return [one for one in members if one.facts["family"] in names][::80]


def export(to, folder, problems):
    assert exports.exported("contact-qp-1", problems, to, folder)


def test_the_bundle_has_every_number_of_the_problems(few, tmp_path):
    export("npz", tmp_path, few)
    with np.load(tmp_path / "contact-qp-1.npz") as bundle:
        assert bundle["id"].tolist() == [one.id for one in few]
        for k, one in enumerate(few):
            if "sparse" in one.facts["tags"]:
                parts = (bundle[f"{k}/A/{key}"] for key in ("values", "columns", "starts"))
                A = csr_matrix(tuple(parts), one.A.shape).toarray()
            else:
                A = bundle[f"{k}/A"]
            np.testing.assert_array_equal(A, one.A.toarray())
            if not one.answer.farkas:
                np.testing.assert_array_equal(bundle[f"{k}/x"], one.answer.x)


def test_matlabs_file_has_every_number_of_the_problems(few, tmp_path):
    export("mat", tmp_path, few)
    problems = loadmat(tmp_path / "contact-qp-1.mat", spmatrix=False)["problems"][0]
    for row, one in zip(problems, few, strict=True):
        assert row["id"][0] == one.id
        A = row["A"].toarray() if "sparse" in one.facts["tags"] else row["A"]
        np.testing.assert_array_equal(A, one.A.toarray())
        np.testing.assert_array_equal(row["x"].ravel(), one.answer.x)


def test_qpbenchmark_runs_the_set_and_its_module_grades_by_exact_answers(
    tmp_path, monkeypatch, capsys
):
    command = ["study", "problems", "export", "--to", "parquet", "--out", str(tmp_path)]
    some = ["--families", "condition,infeasible,wedge", "--every", "60", "--units", "natural"]
    assert main([*command, *some]) == 0
    assert "left out 5 problems" in capsys.readouterr().err
    program = Path(sys.executable).with_name("qpbenchmark")
    module = "contact_qp_1_natural.py"
    done = subprocess.run(
        [program, "--results-path", "results.csv", module, "run", "--solver", "daqp",
         "--author", "nobody"],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (tmp_path / "results.csv").open() as file:
        assert len({row["problem"] for row in csv.DictReader(file)}) == 10
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [module, "daqp"])
    runpy.run_path(module, run_name="__main__")
    assert capsys.readouterr().out.startswith("daqp: median ")
