"""When compiled functions stand in the place of NumPy's, and when they do not."""

import os
from functools import partial
from inspect import unwrap
from timeit import timeit

import pytest

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.contact.batches.balls import OnHalfSpaces
from quasistatic_ref.contact.batches.clouds import Clouds
from quasistatic_ref.model.sums import Sums
from quasistatic_ref.optional.compiled import leaves
from quasistatic_ref.simulate.form_step import StepPlan
from quasistatic_ref.solve.by_group import GroupIndex
from tests.processes import python

pytestmark = pytest.mark.extra("compiled")


FUNCTIONS = [
    unwrap(function)
    for function in (
        Clouds.contacts,
        Sums.plus,
        StepPlan.loads,
        StepPlan.formed,
        OnHalfSpaces.contacts,
        GroupIndex.write,
    )
]


def ball():
    return System([Body.of_shape("ball", Sphere(0.05), mass=0.3)])


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__qualname__)
def test_a_leaf_answers_its_trials(function):
    of, trials = leaves.leaf(function)
    assert all(of(instance)(*arguments) is not None for instance, arguments in trials())
    assert leaves.is_right(function)


@pytest.mark.long
@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__qualname__)
def test_a_leaf_takes_less_time_than_numpy(function):
    """The least of several rounds, in turn, of what its trials ask: as much as a small step."""
    of, trials = leaves.leaf(function)
    for instance, arguments in trials():
        ways = {"C": of(instance), "NumPy": partial(function, instance)}
        rounds = [
            {name: timeit(partial(way, *arguments), number=200) for name, way in ways.items()}
            for _ in range(9)
        ]
        least = {name: min(one[name] for one in rounds) for name in ways}
        ratio = least["C"] / least["NumPy"]
        assert ratio < 1, f"{function.__qualname__} takes {ratio:.2f} of NumPy's time: remove it"


def test_a_leaf_with_other_bits_is_left_out(monkeypatch, capfd):
    """As if a compiler had made it wrong."""
    of, trials = leaves.leaf(FUNCTIONS[1])

    def wrong(sums):
        return lambda *ends: of(sums)(*ends) + 1e-16

    monkeypatch.setattr(leaves, "leaf", lambda function: (wrong, trials))
    leaves.is_right.cache_clear()
    system = ball()
    assert system.integrate(system.q_start, [0.1, 0, 0, 0, 0, 0]).tolist()[0] == 0.1
    assert capfd.readouterr().err == "compiled code is left out: Sums.plus has other bits\n"
    leaves.is_right.cache_clear()


def test_all_functions_are_those_that_the_core_names():
    assert leaves.LEAVES.keys() == {function.__qualname__ for function in FUNCTIONS}


@pytest.mark.parametrize("value", ["0", "1"])
def test_a_variable_of_the_environment_turns_all_off(value):
    code = (
        "from tests.optional.compiled.test_leaves import ball\n"
        "print(hasattr(ball().sums.plus, 'func'))"  # a partial: NumPy's
    )
    done = python("-c", code, env=os.environ | {"QUASISTATIC_REF_COMPILED": value})
    assert done.stdout.split() == [str(value == "0")]
