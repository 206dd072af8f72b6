"""The page as it stands, solved by CVXPY alone: the digits it has, and where CVXPY is imported."""

import math
import re
from collections import defaultdict

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.files.resources import scenario_names
from quasistatic_ref.solve.step_problem import CANON
from tests.closeness import assert_within
from tests.pages import PACKAGE, ROOT

TIGHT = dict.fromkeys(("tol_gap_abs", "tol_gap_rel", "tol_feas"), 1e-12)
CALLS = {
    "Clarabel": ("CLARABEL", {}, 5.0, 10.0),
    "Clarabel at 1e-12": ("CLARABEL", TIGHT, 7.5, 14.0),
    "PIQP": ("PIQP", {}, 6.0, 10.0),
    "OSQP": ("OSQP", {}, 3.0, 15.0),
}
"""Solver, options, and the digits that every step and the median of them have at least."""
PRINTED = 1.0
"""How far Clarabel's digits are from those of the page; other solvers' depend on the processor."""
STILL = 1e-9
"""Length of a step and of its free step [(N m s)^0.5] below which its digits mean nothing."""
NOT_OPTIMAL = {
    # Clarabel's iterates go round four points; without its equilibration it solves both.
    ("allegro_turn", 15, "Clarabel"): "user_limit",
    ("allegro_turn", 15, "Clarabel at 1e-12"): "user_limit",
    ("arm_push", 646, "Clarabel at 1e-12"): "optimal_inaccurate",
}


def digits_of(step, exact, answer):
    """Correct digits, at most 16: in the norm of H, over the longer of step and free step."""
    form = qr.standard_form(step)

    def length(x):
        return math.sqrt(x @ form.H @ x)

    size = max(length(exact), length(np.linalg.solve(form.H, form.g)))
    if size < STILL:
        return None
    return -math.log10(max(length(answer - exact) / size, 1e-16))


@pytest.mark.extra("robots")
@pytest.mark.filterwarnings("ignore:Solution may be inaccurate:UserWarning")  # the status says so
def test_ten_steps_of_every_scenario_are_right_by_every_solver():
    """Steps round((i + 1/2) n / 10) of n; one, of door, is at rest. The page lists the digits."""
    digits = defaultdict(list)
    statuses = {}
    still = []
    for scene in scenario_names():
        scenario = qr.load_scenario(scene, fast=True)
        run = scenario.run(progress=False, findings=False)
        for k in [round((i + 0.5) * scenario.steps / 10) for i in range(10)]:
            step = run.step_data(k)
            exact = qr.solve_step(step, "none").delta_q
            page = qr.StepProblem(step)
            for call, (solver, options, *_) in CALLS.items():
                page.problem.solve(solver=solver, canon_backend=CANON, **options)
                if page.problem.status != "optimal":
                    statuses[scene, k, call] = page.problem.status
                elif (found := digits_of(step, exact, page.delta_q.value)) is not None:
                    digits[call, scene].append(found)
                elif call == "Clarabel":
                    still.append((scene, k))
    assert still == [("door", 475)]
    assert statuses.items() <= NOT_OPTIMAL.items()
    for call, (*_, least, median) in CALLS.items():
        each = np.concatenate([digits[call, scene] for scene in scenario_names()])
        assert min(each) > least, call
        assert np.median(each) > median, call
    text = (ROOT / "docs" / "guides" / "in_python.md").read_text()
    for scene in scenario_names():
        (row,) = re.findall(rf"^\| `{scene}` \| (.*) \|$", text, re.MULTILINE)
        for call, cell in zip(CALLS, row.split(" | "), strict=True):
            printed = [*map(float, cell.split("/"))]
            each = digits[call, scene]
            if "Clarabel" in call:
                assert_within([min(each), np.median(each)], printed, PRINTED)


OWN_INTERFACES = {"solve/interruptible.py", "optional/qp_doors/by_cvxpy.py"}


def test_of_cvxpy_below_its_top_only_its_words_are_imported():
    """And interfaces, which two files make their own of."""
    deeper = {
        name
        for path in PACKAGE.rglob("*.py")
        if path.relative_to(PACKAGE).as_posix() not in OWN_INTERFACES
        for name in re.findall(r"^ *(?:from|import) (cvxpy\.\S+)", path.read_text(), re.MULTILINE)
    }
    assert deeper == {"cvxpy.settings"}
