"""No backend holds up a step at strange scales: one that may is not called."""

from itertools import islice

import pytest

from quasistatic_ref import QuasistaticError, solve_step
from quasistatic_ref.solve.backends import NONE, installed_backends
from quasistatic_ref.solve.choice import solver_for
from tests.oracles.attacked_steps import steps

HOSTILE = list(islice(steps("all scales"), 3))


def end_of(step, solver):
    """The bits of the answer, or the kind of error."""
    try:
        return solve_step(step, solver).delta_q.tobytes()
    except QuasistaticError as error:
        return type(error)


@pytest.fixture(scope="module")
def ends():
    """How each hostile step ends without a backend: some of them with an optimum."""
    ends = [end_of(step, NONE) for step in HOSTILE]
    assert bytes in map(type, ends)
    return ends


@pytest.mark.parametrize("name", installed_backends())
def test_every_backend_by_every_interface_ends_as_none_does(ends, name):
    for step, expected in zip(HOSTILE, ends, strict=True):
        solver = solver_for(step, name)
        assert end_of(step, solver) == expected
