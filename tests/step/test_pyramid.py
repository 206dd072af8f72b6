"""The paper's rows are written once: where one is changed, everything that has rows follows."""

import json
import os
import shutil

import numpy as np
import pytest

from quasistatic_ref import Extra, StepProblem, solve_step, verify_answer
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.step import cones
from quasistatic_ref.step.pyramid import pyramid
from quasistatic_ref.step.standard_form import contact_inequalities, frame_jacobian
from tests.closeness import assert_close, assert_within
from tests.helpers import error, random_step, rows_by_hand
from tests.pages import PACKAGE, ROOT
from tests.processes import python
from tests.tolerances import OPTIMUM, ROUNDING

HALVED = {f"gap {sign} slip_2,": f"gap {sign} 0.5 * slip_2," for sign in "+-"}
"""Friction along d2 is half of the paper's."""
BORNE = 1e-5
"""What the compliance of forces leaves unborne, and what rounding of it leaves open."""
LEFT_OUT = "compiled code is left out: StepPlan.formed has other bits\n"


def of_slip_2(A, counts, factor):
    """The rows of contacts with another friction along d2: its share of rows +d2 and -d2 scaled.

    What is left of a row is the gap's, half of the sum of rows +d1 and -d1.
    """
    A = A.copy()
    first = np.cumsum(counts) - counts
    of_gap = (A[first] + A[first + 2]) / 2
    for i in (1, 3):
        A[first + i] = of_gap + factor * (A[first + i] - of_gap)
    return A


def asked(folder, compiled):
    """What a copy of the package says in a new process, and on standard error."""
    surroundings = {"PYTHONPATH": f"{folder}:{ROOT}", "QUASISTATIC_REF_COMPILED": compiled}
    module = "tests.step.rows_asked"
    done = python("-m", module, cwd=folder, env=os.environ | surroundings)
    answers = json.loads(done.stdout)
    assert answers["file"].startswith(str(folder))
    return {k: np.array(v) if isinstance(v, list) else v for k, v in answers.items()}, done.stderr


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    """A folder with a copy of the package, and what it says."""
    folder = tmp_path_factory.mktemp("copied")
    left_out = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, folder / PACKAGE.name, ignore=left_out)
    for name in ("models", "validation", "pyproject.toml"):
        (folder / name).symlink_to(ROOT / name)
    return folder, asked(folder, "1")[0]


@pytest.mark.parametrize("compiled", [pytest.param("1", marks=pytest.mark.extra("compiled")), "0"])
def test_a_changed_row_changes_page_a_exact_answer_run_and_own_vectors(copied, compiled):
    """The plain program's vectors, the tests of equations and check_solution.py object."""
    folder, before = copied
    file = folder / PACKAGE.name / "step" / "pyramid.py"
    text = file.read_text()
    changed = text
    for line, other in HALVED.items():
        assert text.count(line) == 1
        changed = changed.replace(line, other)
    file.write_text(changed)
    try:
        after, errors = asked(folder, compiled)
    finally:
        file.write_text(text)
    for said in (before, after):
        assert_within(said["page"] - said["exact"], 0.0, 1e-9)
        assert np.array_equal(said["run"], said["exact"])
        assert not len(said["findings"])  # no backend is blamed
    assert np.abs(after["run"] - before["run"]).max() > 1e-6
    for name in ("A", "own"):
        counts = before[f"rows of {name}"]
        assert_close(after[name], of_slip_2(before[name], counts, 0.5), ROUNDING)
    objecting = ("vectors", "equations", "check_solution")
    assert [before[name] for name in objecting] == ["passed", True, True]
    assert [after[name] for name in objecting] == ["failed", False, False]
    assert (LEFT_OUT in errors) == (compiled == "1")


def tripled(gap, slip_1, slip_2, spin):
    """Rows with three times the friction along d2."""
    return (gap + slip_1, gap + 3 * slip_2, gap - slip_1, gap - 3 * slip_2, gap + spin, gap - spin)


@pytest.mark.parametrize("how", ["in its place", "by its name"])
def test_rows_that_change_in_a_process_are_noticed(how, monkeypatch, rng):
    """As by a notebook's autoreload, or where another function stands in the module.

    The same rows by hand, as a user's own of contacts without friction, have the same optimum.
    """
    step = random_step(rng)
    before = solve_step(step, "none")
    StepProblem(step).solve()
    assert before.forces.any()
    if how == "in its place":
        monkeypatch.setattr(pyramid, "__code__", tripled.__code__)
    else:
        monkeypatch.setattr(cones, "pyramid", tripled)
        cones.cone.cache_clear()
    rows = of_slip_2(rows_by_hand(step), step.counts, 3.0)
    b = -np.repeat(step.contacts.phi, step.counts)
    by_hand = Extra([f"row {i}" for i in range(len(b))], rows, b)
    truth = solve_step(step.replace(cone="frictionless", extra=by_hand), "none").delta_q
    after = solve_step(step, "none")
    assert error(step, before.delta_q, truth) > 1e-3
    assert_within(error(step, after.delta_q, truth), 0.0, ROUNDING)
    assert_within(error(step, StepProblem(step).solve(), truth), 0.0, OPTIMUM)
    assert_close(contact_inequalities(step.contacts, step.cone, step.mask)[0], rows, ROUNDING)
    assert verify_answer(step, after.delta_q, after.certificate.active, after.lam)
    J = np.stack(frame_jacobian(step.contacts, step.contacts.J), axis=1)
    J = J[:, [1, 2, 0, 3]]  # of forces along d1, d2 and n, and of torques about n
    pushed = step.h * np.einsum("cij,ci->j", J, after.wrench)
    assert_close(pushed, rows.T @ after.lam, ROUNDING)
    assert_close(step.h * np.einsum("cij,ci->j", J, after.forces), pushed, BORNE)
    most = np.abs(truth)
    assert (StepProgram(step).sizes(most) >= np.abs(rows) @ most + np.abs(b)).all()


@pytest.fixture(autouse=True)
def cones_as_they_are():
    """Cones of a changed function are forgotten."""
    yield
    cones.cone.cache_clear()
