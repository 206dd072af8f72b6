"""The test set: the same from the same seed, kept with its answers, readable by qpbenchmark."""

import csv
import subprocess
import sys

import numpy as np
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.file.study_file import FAMILIES, TestSet
from quasistatic_ref.lab.study.problems.parquet import benchmark_written
from quasistatic_ref.lab.study.problems.qp import condition
from quasistatic_ref.lab.study.problems.study_problems import (
    NUMBERS,
    made,
    problem_set,
    problems_read,
    set_record,
)
from quasistatic_ref.lab.study.problems.study_problems import study_problems as problems

EACH = {"scenarios": 3, "contacts": 3, "mass_ratio": 4, "time_step": 0, "closest_points": 0,
        "bodies": 1}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("set")
    problem_set(TestSet(1, EACH, ("block_incline",)), place, progress=False)
    return place


def test_what_is_read_is_what_was_made_to_the_last_bit(folder):
    again = problem_set(TestSet(1, EACH, ("block_incline",)), folder / "again", progress=False)
    read = problems_read(folder)
    assert len(read) == sum(EACH.values())
    assert set_record(read) == set_record(again)
    for one, two in zip(read, again, strict=True):
        assert vars(one.facts) == vars(two.facts)
        np.testing.assert_array_equal(one.form.A, two.form.A)


def test_ctrl_c_keeps_the_problems_that_were_made(folder, tmp_path, monkeypatch):
    honest, calls = problems.answer_of, []

    def interrupted(form):
        calls.append(form)
        if len(calls) in (5, 8):
            raise KeyboardInterrupt
        return honest(form)

    monkeypatch.setattr(problems, "answer_of", interrupted)
    test_set = TestSet(1, EACH, ("block_incline",))
    for kept in (4, 4 + 2):
        with pytest.raises(KeyboardInterrupt):
            problem_set(test_set, tmp_path, progress=False)
        assert len(problems_read(tmp_path / problems.BEGUN)) == kept
        assert not (tmp_path / problems.HEADER).exists()
    made_whole = problem_set(test_set, tmp_path, progress=False)
    # No answer is sought twice, but for those in which the keys were pressed.
    assert len(calls) == sum(EACH.values()) + 2
    assert set_record(made_whole) == set_record(problems_read(folder))
    assert not (tmp_path / problems.BEGUN).exists()


def test_another_seed_makes_other_problems():
    few = dict.fromkeys(FAMILIES, 0) | {"contacts": 2}
    one, two = (next(iter(made(TestSet(seed, few, ())))) for seed in (1, 2))
    assert one.id == two.id
    assert not np.array_equal(one.step.tau_u, two.step.tau_u)


def test_the_scaled_families_span_what_they_say():
    few = dict.fromkeys(FAMILIES, 0) | {"contacts": 4, "mass_ratio": 4, "time_step": 4}
    steps = list(made(TestSet(1, few | {"time_step": 0}, ())))
    contacts = [m.step.contacts.n_c for m in steps if m.family == "contacts"]
    assert contacts == [1, 10, 100, 1000]
    ratios = [m.step.M_u[6, 6] / m.step.M_u[0, 0] for m in steps if m.family == "mass_ratio"]
    np.testing.assert_allclose(ratios, [1, 1e3, 1e6, 1e9], rtol=1e-12)


def test_the_condition_number_grows_with_the_mass_ratio(folder):
    found = {p.facts.mass_ratio: condition(p.form) for p in problems_read(folder)
             if p.facts.family == "mass_ratio"}  # fmt: skip
    assert found[1e9] / found[1e6] == pytest.approx(1e3, rel=0.01)


def test_another_test_set_in_the_folder_is_refused(folder):
    with pytest.raises(InputError, match="holds another test set"):
        problem_set(TestSet(2, EACH, ("block_incline",)), folder, progress=False)


def test_a_test_set_whose_numbers_were_changed_is_refused(folder, tmp_path):
    for path in folder.glob("problems.*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    with np.load(folder / NUMBERS) as arrays:
        numbers = dict(arrays)
    numbers["g"][0] += 1e-9
    np.savez(tmp_path / NUMBERS, **numbers)
    with pytest.raises(InputError, match="was changed"):
        problems_read(tmp_path)


TWO_SOLVERS = """
import sys
from qpbenchmark.benchmark import main
given = "--results-path results.csv contact_natural.py run --author nobody --solver".split()
for solver in ("clarabel", "daqp"):
    sys.argv[1:] = [*given, solver]
    main()
"""
"""What its program does twice, in one process: to import it takes longer than to run it."""


def test_qpbenchmark_itself_runs_the_exported_test_set_with_two_solvers(folder, tmp_path):
    benchmark_written(folder, tmp_path, every=4)
    names = [p.id for p in problems_read(folder)[::4]]
    done = subprocess.run(
        [sys.executable, "-c", TWO_SOLVERS],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (tmp_path / "results.csv").open() as file:
        rows = list(csv.DictReader(file))
    settings = ("default", "low_accuracy", "mid_accuracy", "high_accuracy")
    planned = {(p, s, t) for p in names for s in ("clarabel", "daqp") for t in settings}
    assert {(r["problem"], r["solver"], r["settings"]) for r in rows} == planned
    found = [r for r in rows if r["solver"] == "daqp" and r["settings"] == "high_accuracy"]
    assert {r["found"] for r in found} == {"True"}
    assert max(float(r["primal_residual"]) for r in found) < 1e-8


def test_the_exported_bundle_holds_the_exact_answers(folder, tmp_path):
    """In natural units as in raw ones, A delta_q >= b and H delta_q - g is in the rows' cone."""
    benchmark_written(folder, tmp_path)
    for units in ("raw", "natural"):
        with np.load(tmp_path / f"contact_{units}.npz") as bundle:
            for k in range(len(bundle["name"])):
                A, b, x = (bundle[f"{k}/{key}"] for key in ("A", "b", "delta_q"))
                scale = np.abs(A) @ np.abs(x) + np.abs(b)
                assert (A @ x - b >= -1e-14 * scale.max()).all()
