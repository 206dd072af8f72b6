"""A plain, proved step of the bunny makes few calls and few kinds of objects: it can be read."""

import statistics
import sys
from inspect import CO_GENERATOR

import pytest

from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from tests.pages import PACKAGE

CALLS = 450
KINDS = 19, 22  # the last three in few of the 300 steps
MAKERS = {"__init__", "<lambda>", "unchecked"}  # a lambda makes what inherits from NamedTuple


def made(frame):
    """The class of the package of which a call makes an object, if any."""
    code = frame.f_code
    if code.co_name in MAKERS and code.co_argcount:
        first = frame.f_locals[code.co_varnames[0]]
        kind = first if isinstance(first, type) else type(first)
        if kind.__module__.startswith("quasistatic_ref"):
            yield kind


@pytest.mark.parametrize(
    ("steps", "apart", "most"),
    [(31, 10, KINDS[0]), pytest.param(300, 1, KINDS[1], marks=pytest.mark.long)],
)
def test_a_step_makes_few_calls_and_few_kinds_of_objects(steps, apart, most, monkeypatch):
    """Calls of the package's functions, generators and lambdas apart, in the median step."""
    plain = Simulator.step
    calls, kinds = [], set()

    def traced(*arguments):
        calls.append(0)

        def note(frame, event, _):
            code = frame.f_code
            if event == "call":
                kinds.update(made(frame))
                own = code.co_filename.startswith(str(PACKAGE)) and not code.co_name.startswith("<")
                calls[-1] += own and not code.co_flags & CO_GENERATOR

        measured = len(calls) > 1 and len(calls) % apart == 0  # the first compiles the problem
        sys.setprofile(note if measured else None)
        try:
            return plain(*arguments)
        finally:
            sys.setprofile(None)

    monkeypatch.setattr(Simulator, "step", traced)
    load_scenario("bunny_grasp", steps=steps).run()
    assert statistics.median(filter(None, calls)) <= CALLS
    assert len(kinds) <= most, sorted(kind.__name__ for kind in kinds)
