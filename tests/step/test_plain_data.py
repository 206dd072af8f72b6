"""Plain data: what is public is compared bit for bit, copied and pickled, and works the same."""

import copy
import pickle
import shutil
from dataclasses import dataclass, replace

import numpy as np

from quasistatic_ref import Box, Cone, Cylinder, Extra, Simulator, Sphere, load_scenario
from tests.cases import cases
from tests.closeness import assert_same
from tests.made import Plain, bits
from tests.scenes import written_scenario
from tests.step.public_data import contradiction_error

ROUND_TRIPS = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "copy": copy.copy,
}


NAN = np.nan


every_trip = cases("trip", ROUND_TRIPS)


@every_trip
def test_a_copy_is_equal_and_of_the_same_class_and_hash(things, trip):
    for name, thing in things.items():
        again = trip(thing)
        assert type(again) is type(thing), name
        if isinstance(thing, Exception):
            assert bits((again.args, vars(again))) == bits((thing.args, vars(thing))), name
            assert str(again) == str(thing), name
            continue
        assert again == thing, name
        assert hash(again) == hash(thing), name


def test_a_pickled_system_does_not_need_its_files(tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    system = load_scenario(written_scenario(folder), fast=True).system
    text = pickle.dumps(system)
    shutil.rmtree(folder)
    again = pickle.loads(text)
    q = system.q_start
    assert again.M_u(q).tobytes() == system.M_u(q).tobytes()
    assert again.links == system.links


@every_trip
def test_a_copy_of_a_simulator_has_every_setting(things, trip):
    scenario = things["Scenario"]
    given = {
        "h": 0.002,
        "K_q": np.diag([3.0, 4.0]),
        "gravity": (1.0, 2.0, 3.0),
        "gravity_acts": np.array([True, False]),
        "backend": "osqp",
        "accuracy": 1e-7,
        "certify": "full",
        "cone": "product",
        "law": "coulomb",
        "distances": "closed",
        "extension": contradiction_error,  # any function that a pickle finds by its name
        "limits": replace(scenario.limits, reach=7.0),
    }
    _, (kind, again) = trip(Simulator(scenario.system, scenario.pairs, **given)).__reduce__()
    assert kind is Simulator
    system = again.pop("system")
    assert system == scenario.system
    assert (system is scenario.system) == (trip is copy.copy)  # others are for other threads
    assert again.pop("pairs") == tuple(scenario.pairs)
    assert set(again) == set(given)
    for name, value in given.items():
        assert_same(again[name], value)


def test_the_time_of_a_solver_is_not_compared_but_copied(things):
    solution = things["StepSolution"]
    result = things["StepResult"]
    slower = solution.statistics.with_fields(solve_time=1e3)
    assert replace(solution, statistics=slower) == solution
    assert replace(result, seconds={"solve": 1e3}) == result
    assert copy.deepcopy(replace(solution, statistics=slower)).statistics == slower


@dataclass(frozen=True, eq=False)
class Some(Plain):
    """Anything."""

    value: object


ALIKE = {
    "NaN": (NAN, float("nan")),
    "NaN in an array": (np.array([NAN]), np.array([NAN])),
    "-0.0 and 0.0": (0.0, -0.0),
    "-0.0 and 0.0 in an array": (np.zeros(1), -np.zeros(1)),
    "a mapping in another order": ({"a": 1, "b": 2}, {"b": 2, "a": 1}),
}


UNLIKE = {
    "one ulp": (1.0, np.nextafter(1.0, 2.0)),
    "a float and an integer": (1.0, 1),
    "float64 and float32": (np.ones(1), np.ones(1, np.float32)),
    "another shape": (np.ones((1, 2)), np.ones((2, 1))),
    "a tuple and a list": ((1,), [1]),
    "solids of the same fields": (Cylinder(0.1, 0.4), Cone(0.1, 0.4)),
    "deep down": ({"a": [np.ones(1)]}, {"a": [np.zeros(1)]}),
}


@cases("one, two", ALIKE)
def test_data_of_the_same_bits_are_equal(one, two):
    assert Some(one) == Some(two)
    assert hash(Some(one)) == hash(Some(two))


@cases("one, two", UNLIKE)
def test_data_of_other_bits_are_not_equal(one, two):
    assert Some(one) != Some(two)


def test_plain_data_equals_nothing_else(things):
    assert Sphere(1.0) != Box([1.0, 1.0, 1.0])
    assert Some(1.0) != 1.0
    assert Extra((), np.zeros((0, 1)), []) != things["Extra"]
