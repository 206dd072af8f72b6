"""What all that has the paper's rows says, as JSON, in the process of another copy of the package.

The plain program, the tests of equations and ``check_solution.py`` are not of that copy.
"""

import json
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.step.standard_form import contact_inequalities
from tests.equations.test_eq05_tangential_directions import (
    test_tangents_are_those_that_the_first_two_constraints_add_to_the_gap as eq_5,
)
from tests.lab.vectors.committed_cases import inputs_of, own_answer, verdict_on
from validation.check_solution import solution_read, step_read, table, verdicts

CASE = "rows/random/3"


def agrees(check):
    """Whether a check passes that asserts."""
    try:
        check(np.random.default_rng(0))
    except AssertionError:
        return False
    return True


def judged(step, solution):
    """Whether each claim of a solution's file holds."""
    with TemporaryDirectory() as folder:
        files = Path(folder, "step.json"), Path(folder, "solution.json")
        qr.save_step(files[0], step)
        qr.save_solution(files[1], solution)
        of_step, of_solution = map(table, files)
    return all(holds for _, holds in verdicts(step_read(of_step), solution_read(of_solution)))


def main():
    """Print it."""
    run = qr.load_scenario("two_finger_pinch", steps=1).run(progress=False)
    step = run.step_data(0)
    page = qr.StepProblem(step)
    page.problem.solve(solver="CLARABEL")
    solution = qr.solve_step(step, backend="none")
    A, _ = contact_inequalities(step.contacts, step.cone, step.mask)
    own = own_answer("rows", inputs_of(CASE))
    answers = {
        "file": qr.__file__,
        "findings": [finding.name for finding in run.findings],
        "page": page.delta_q.value,
        "exact": solution.delta_q,
        "run": run.delta_q[0],
        "A": A,
        "rows of A": step.contacts.rows,
        "own": own["A"],
        "rows of own": [contact["rows"] for contact in inputs_of(CASE)["contacts"]],
        "vectors": verdict_on(CASE, own).verdict,
        "equations": agrees(eq_5),
        "check_solution": judged(step, solution),
    }
    json.dump(answers, sys.stdout, default=np.ndarray.tolist)


if __name__ == "__main__":
    main()
