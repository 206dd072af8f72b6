"""Set-up and solving, as solvers report them, are parts of a call that a study times."""

import pytest

from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Solver
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import Limits, measured


@pytest.mark.parametrize("name", ["native:piqp", "cvxpy:scs"])
def test_set_up_and_solving_are_parts_of_a_call(name, problem):
    interface, _, solver = name.partition(":")
    every = []
    with Keeper(Solver(solver, interface, solver)) as keeper:
        for _ in range(4):  # another program may come between
            row = measured(keeper, problem, SETTINGS[0], "natural", False, Limits(20.0))
            every.append(row["seconds"])
            parts = sum(every[-1][part] or 0.0 for part in ("setup", "solver"))
            assert parts > 0
            if parts < 2 * every[-1]["high"]:
                break
        else:
            pytest.fail(f"more than the call: {every}")
    assert every[0]["start"] > 0.05  # imports, besides the call's time
