"""Natural units in compiled code: those of NumPy, or none where the order of a sum decides."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.compiled import natural
from quasistatic_ref.solve.units import hessian_in_both_units, units_of
from quasistatic_ref.step.standard_form import StandardForm
from tests.optional.fast.compiled.test_fast import needs_compiler

pytestmark = needs_compiler
HALF = np.sqrt(2.0)
"""Between 1 and 2, as near to one as to the other by its logarithm."""


def units(H, g, A, b):
    """Units by C, and by NumPy; and the program that C has written, None if it has not."""
    H, g, A, b = (np.array(values, dtype=np.float64) for values in (H, g, A, b))
    hessian = hessian_in_both_units(H)
    solver = SimpleNamespace(written=None)
    program = Program(H, np.zeros(len(g)), np.zeros(A.shape), np.zeros(len(b)))
    made = natural.NaturalProgram({"g": g, "A": A, "b": b}, solver, program, hessian)
    found = made.written()
    with np.errstate(all="ignore"):
        expected = units_of(StandardForm(H, g, A, b), hessian)
    assert solver.written is found
    return found, expected, program


DECIDED = {
    "rows of one length": ([3.0, 0.0], [[1.0, 0.0]], [-1.0]),
    "an even number of rows": ([3.0, 0.0], [[1.0, 0.0], [0.0, 5.0]], [-1.0, -1.0]),
    "rows of many lengths": (
        [3.0, 0.0],
        [[2.0**k, 0.0] for k in (6, 0, 10, 2, 8, 1, 4)],
        [-1.0] * 7,
    ),
    "rows of zeros beside others": ([3.0, 0.0], [[0.0, 0.0], [0.0, 7.0], [0.0, 0.0]], [0.0] * 3),
    "rows of zeros alone": ([3.0, 0.0], [[0.0, 0.0]], [-1.0]),
    "penetration": ([1e-3, 0.0], [[4.0, 0.0]], [9.0]),
    "no load, and a gap": ([0.0, 0.0], [[4.0, 0.0]], [-9.0]),
    "nothing at all": ([0.0, 0.0], [[4.0, 0.0]], [0.0]),
}
OPEN = {
    "a row whose length is between two powers": ([3.0, 0.0], [[1.0, 1.0]], [-1.0]),
    "a load between two powers": ([1.0, 1.0], [[1.0, 0.0]], [-1.0]),
    "a load next to that": ([HALF, 1e-13], [[1.0, 0.0]], [-1.0]),
    "a load whose square vanishes": ([1e-200, 0.0], [[4.0, 0.0]], [-1.0]),
    "a push out between two powers": ([0.0, 0.0], [[1.0, 0.0]], [HALF]),
    "a number that is none": ([np.nan, 0.0], [[1.0, 0.0]], [-1.0]),
    "an infinite gap": ([1.0, 0.0], [[1.0, 0.0]], [-np.inf]),
    "a row that is too long": ([1.0, 0.0], [[1e200, 0.0]], [-1.0]),
    "a row that is too short": ([1.0, 0.0], [[1e-150, 0.0]], [-1.0]),
}


@pytest.mark.parametrize("case", DECIDED.values(), ids=DECIDED)
def test_units_are_those_of_numpy(case):
    found, expected, program = units(np.diag([1.0, 16.0]), *case)
    assert (found.length, found.size) == (expected.length, expected.size)
    assert (found.coordinate == [1.0, 0.25]).all()
    g, A, b = map(np.array, case)
    S, ell, rho = found
    assert program.f.tobytes() == (g * (S / -rho)).tobytes()
    assert program.A.tobytes() == (A * (S / ell)).tobytes()
    assert program.b.tobytes() == (b * (1 / (rho * ell))).tobytes()


@pytest.mark.parametrize("case", OPEN.values(), ids=OPEN)
def test_units_that_an_order_of_sums_may_decide_are_left_to_numpy(case):
    found, _, program = units(np.eye(2), *case)
    assert found is None
    assert not any(part.any() for part in (program.f, program.A, program.b))
