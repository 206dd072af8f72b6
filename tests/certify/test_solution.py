"""Solutions as data: the multipliers of a user's own rows, and those below zero in a file."""

import json

import numpy as np
import pytest

from quasistatic_ref import Certificate
from quasistatic_ref.certify.solution import SolverStatistics, step_solution
from quasistatic_ref.cli.solution_files import solution_text
from tests.helpers import random_step

STEP = random_step(np.random.default_rng(3), rows=(6, 4))
SAID = SolverStatistics("none", "optimal", None, None, 1e-12)


def test_multipliers_of_own_rows_are_the_last():
    lam = np.arange(12.0)
    solution = step_solution(STEP, np.zeros(7), lam, Certificate("none"), SAID)
    assert solution.lam.tolist() == lam[:10].tolist()
    assert solution.lam_extra.tolist() == [10.0, 11.0]


@pytest.mark.parametrize(("bound", "written"), [(1e-9, 0.0), (None, -1e-9)])
def test_multipliers_below_zero_are_written_as_the_bound_takes_them(bound, written):
    lam = np.ones(10)
    lam[1] = -1e-9
    claims = Certificate("residual", dict.fromkeys(("stationarity", "primal", "dual",
                         "complementarity"), 0.0), error_bound=bound)  # fmt: skip
    solution = step_solution(STEP, np.zeros(7), lam, claims, SAID)
    assert json.loads(solution_text(solution))["lam"][0][1] == written
