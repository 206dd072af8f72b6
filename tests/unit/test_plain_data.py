"""Plain data: what is public is compared bit for bit, copied and pickled, and works the same."""

import copy
import pickle
import shutil
from dataclasses import dataclass, replace

import numpy as np
import pytest

from quasistatic_ref.errors import (
    InputError,
    LimitExceeded,
    RunFailed,
    StepDataError,
    StepInfeasible,
    StepNotSolved,
)
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.model.shapes import Box, HalfSpace, PointCloud, Sphere
from quasistatic_ref.plain import Plain
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.contacts import Contacts, SparseContacts
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.posed import PosedStep
from tests.helpers import always_in_blocks, changed, contacts_of, pinch, random_step
from tests.scenes import chain_scene, written_scenario

ROUND_TRIPS = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}
NAN, INF = np.nan, np.inf
DOWN = np.array([0.0, 0.0, -9.81])


def squeezed():
    """The error about a step whose two contacts contradict each other."""
    frames = [[[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 0, 0], [0, -1, 0], [0, 0, -1]]]
    J = np.zeros((2, 4, 1))
    J[:, 2, 0] = 1.0
    contacts = contacts_of(-1e-3, frames, J, 0.0, 0.0, (4, 4))
    step = StepData(0.01, [[]], [[1.0]], [], [0.0], [], contacts)
    with pytest.raises(StepInfeasible) as caught:
        solve_step(step, "none")
    return caught.value


def sparse_step():
    """A step whose contacts are in blocks, as its simulator poses it."""
    some = pile((2, 1, 2), certify="off")
    with pytest.MonkeyPatch.context() as patch:
        always_in_blocks(patch)
        return copy.copy(some.simulator).step(some.q, np.zeros(0), some.force).step


@pytest.fixture(scope="module")
def things(tmp_path_factory):
    """Every kind of public data, by name."""
    scenario = load_scenario(written_scenario(tmp_path_factory.mktemp("scene")))
    grasp = load_scenario("bunny_grasp", ["steps=2"])
    system, simulator = scenario.system, scenario.simulator()
    result = simulator.step(system.q_start, scenario.targets(scenario.h))
    run = rollout(simulator, system.q_start, scenario.targets, 3, progress=False)
    step = random_step(np.random.default_rng(0))
    extra = Extra(("a", "b"), np.ones((2, 7)), [-1.0, -2.0])
    solution = solve_step(step)
    infeasible = squeezed()
    return {
        "StepData": step,
        "StepData with rows of a user's": step.replace(extra=extra),
        "PosedStep": result.step,
        "sparse PosedStep": sparse_step(),
        "Contacts": step.contacts,
        "PosedContacts": result.step.contacts,
        "SparseContacts": sparse_step().contacts,
        "Blocks": sparse_step().contacts.blocks,
        "Extra": extra,
        "StepSolution": solution,
        "Certificate": solution.certificate,
        "StepResult": result,
        "Trajectory": run,
        "System": system,
        "System of the grasp": grasp.system,
        "Body": system.bodies[0],
        "ContactPair": grasp.pairs[0],
        "Scenario": scenario,
        "Scenario of the grasp": grasp,
        "Targets": scenario.targets,
        "Limits": scenario.limits,
        "Wrenches": scenario.wrenches,
        "Sphere": Sphere(0.1),
        "Box": Box([0.1, 0.2, 0.3]),
        # Its normal is divided by its length when it is made; a second time would change bits.
        "HalfSpace": HalfSpace([1.0, 2.0, 3.0], 0.1),
        "PointCloud": PointCloud(np.eye(3)),
        "FarkasVector": infeasible.farkas,
        "InputError": InputError("is bad", field="h", value=np.arange(3.0), file="step.json"),
        "StepDataError": StepDataError("is bad", field="h", value=NAN),
        "StepNotSolved": StepNotSolved("osqp", "user_limit", step, 1e-9),
        "StepInfeasible": infeasible,
        "LimitExceeded": LimitExceeded("is too deep", step),
        "RunFailed": RunFailed("step 3: is too deep", run, step),
    }


NAMES = (
    "StepData", "StepData with rows of a user's", "PosedStep", "sparse PosedStep", "Contacts",
    "PosedContacts", "SparseContacts", "Blocks", "Extra", "StepSolution", "Certificate",
    "StepResult", "Trajectory", "System", "System of the grasp", "Body", "ContactPair", "Scenario",
    "Scenario of the grasp", "Targets", "Limits", "Wrenches", "Sphere", "Box", "HalfSpace",
    "PointCloud", "FarkasVector", "InputError", "StepDataError", "StepNotSolved", "StepInfeasible",
    "LimitExceeded", "RunFailed",
)  # fmt: skip
every_trip = pytest.mark.parametrize("trip", ROUND_TRIPS.values(), ids=ROUND_TRIPS)


def test_no_kind_of_data_is_left_out(things):
    assert tuple(things) == NAMES


@every_trip
@pytest.mark.parametrize("name", NAMES)
def test_a_copy_is_equal_and_of_the_same_class_and_hash(things, name, trip):
    thing = things[name]
    again = trip(thing)
    assert type(again) is type(thing)
    assert again == thing
    assert hash(again) == hash(thing)
    if isinstance(thing, Exception):
        assert str(again) == str(thing)


@pytest.mark.parametrize("name", NAMES)
def test_no_two_kinds_of_data_are_equal(things, name):
    assert [other for other in NAMES if things[other] == things[name]] == [name]


@every_trip
@pytest.mark.parametrize("name", [name for name in NAMES if "Step" in name])
def test_a_copy_can_be_written_no_more_than_what_it_is_a_copy_of(things, name, trip):
    def locked(data):
        for key, value in vars(data).items():
            if isinstance(value, Plain):
                yield from locked(value)
            elif isinstance(value, np.ndarray) and not value.flags.writeable:
                yield key

    again = sorted(locked(trip(things[name])))
    kept = sorted(key for key in locked(things[name]))
    derived = {"H", "mu", "wrench"}  # a copy forms them when they are asked for
    assert [key for key in again if key not in derived] == [k for k in kept if k not in derived]


@every_trip
@pytest.mark.parametrize("name", ["StepData", "StepData with rows of a user's", "PosedStep"])
def test_a_copy_of_a_step_is_solved_to_the_same_bits(things, name, trip):
    one, two = solve_step(things[name]), solve_step(trip(things[name]))
    assert one.certificate.kind == "exact"
    assert one == two


@every_trip
def test_a_copy_of_a_sparse_step_is_solved_to_the_same_bits(things, trip):
    step = things["sparse PosedStep"]
    one, two = (solve_step(some, certify="residual") for some in (step, trip(step)))
    assert one == two


@every_trip
@pytest.mark.parametrize("name", ["System", "System of the grasp"])
def test_a_copy_of_a_system_computes_the_same_bits(things, name, trip):
    system = things[name]
    again, q = trip(system), system.integrate(system.q_start, 0.01 * np.cos(np.arange(system.n_v)))
    for one, two in (
        (system.M_u(q), again.M_u(q)),
        (system.kinematics(q).J, again.kinematics(q).J),
        (system.gravity_force(q, DOWN), again.gravity_force(q, DOWN)),
        (system.q_start, again.q_start),
    ):
        assert one.tobytes() == two.tobytes()
        assert one.size


def test_two_copies_of_a_system_fall_each_its_own_way(things):
    system = things["System of the grasp"]
    up = tuple(-DOWN)
    alone = system.gravity_force(system.q_start, tuple(DOWN))
    other = copy.copy(system).gravity_force(system.q_start, up)
    assert alone.any()
    np.testing.assert_array_equal(other, -alone)
    np.testing.assert_array_equal(system.gravity_force(system.q_start, tuple(DOWN)), alone)


def test_a_pickled_system_does_not_need_its_files(tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    system = load_scenario(written_scenario(folder)).system
    text = pickle.dumps(system)
    shutil.rmtree(folder)
    again = pickle.loads(text)
    q = system.q_start
    assert again.M_u(q).tobytes() == system.M_u(q).tobytes()
    assert again.links == system.links


@every_trip
@pytest.mark.parametrize("name", ["Scenario", "Scenario of the grasp"])
def test_a_copy_of_a_scenario_runs_to_the_same_bits(things, name, trip):
    assert trip(things[name]).run(progress=False) == things[name].run(progress=False)


@every_trip
def test_a_copy_of_a_simulator_takes_the_same_step_afresh(things, trip):
    scenario = replace(things["Scenario of the grasp"], certify="off", backend="daqp")
    one, q = scenario.simulator(), scenario.system.q_start
    first = one.step(q, scenario.targets(0.01))
    assert trip(one).step(q, scenario.targets(0.01)) == first


@every_trip
def test_a_copy_of_a_simulator_has_every_setting(things, trip):
    scenario = things["Scenario"]
    given = {
        "h": 0.002,
        "K_q": np.diag([3.0, 4.0]),
        "gravity": (1.0, 2.0, 3.0),
        "feels_gravity": np.array([True, False]),
        "solver": "osqp",
        "engine": "cvxpy",
        "accuracy": 1e-7,
        "certify": "off",
        "cone": "product",
        "extension": squeezed,  # any function that a pickle finds by its name
        "limits": replace(scenario.limits, reach=7.0),
    }
    again, arguments = trip(Simulator(scenario.system, scenario.pairs, **given)).__reduce__()
    assert arguments == ()
    assert again.func is Simulator
    assert again.args == (scenario.system, tuple(scenario.pairs))
    assert set(again.keywords) == set(given)
    for name, value in given.items():
        np.testing.assert_array_equal(again.keywords[name], value)


def test_equality_sees_one_bit_in_every_field_of_a_solution(things):
    solution = things["StepSolution"]
    for name in ("delta_q", "lam"):
        array = getattr(solution, name).copy()
        array.flat[0] = np.nextafter(array.flat[0], INF)
        assert replace(solution, **{name: array}) != solution
    longer = np.append(solution.lam_extra, 1.0)
    heavier = solution.step.replace(M_u=2 * solution.step.M_u)
    other = {"lam_extra": longer, "backend": "osqp", "certificate": 0, "step": heavier}
    for name, value in other.items():
        assert replace(solution, **{name: value}) != solution


def test_what_a_solver_took_of_the_clock_is_not_compared_but_copied(things):
    solution, result = things["StepSolution"], things["StepResult"]
    slower = solution.statistics._replace(solve_time=1e3)
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
    "deep down": ({"a": [np.ones(1)]}, {"a": [np.zeros(1)]}),
}


@pytest.mark.parametrize(("one", "two"), ALIKE.values(), ids=ALIKE)
def test_alike(one, two):
    assert Some(one) == Some(two)
    assert hash(Some(one)) == hash(Some(two))


@pytest.mark.parametrize(("one", "two"), UNLIKE.values(), ids=UNLIKE)
def test_unlike(one, two):
    assert Some(one) != Some(two)


def test_plain_data_equals_nothing_else(things):
    assert Sphere(1.0) != Box([1.0, 1.0, 1.0])
    assert Some(1.0) != 1.0
    assert Extra((), np.zeros((0, 1)), []) != things["Extra"]


def test_a_posed_step_is_equal_to_the_checked_one_and_to_the_one_of_a_file(things):
    posed = things["PosedStep"]
    checked = posed.replace()
    assert type(posed) is PosedStep
    assert (type(checked), type(checked.contacts)) == (StepData, Contacts)
    assert checked == posed
    assert things["Trajectory"].step_data(0) == posed
    for name in ("H", "counts", "mask", "offsets"):
        np.testing.assert_array_equal(getattr(checked, name), getattr(posed, name))


@pytest.mark.parametrize("name", ["PosedStep", "sparse PosedStep"])
def test_whatever_is_made_of_a_posed_step_is_checked(things, name):
    step = things[name]
    with pytest.raises(StepDataError, match=r"^tau_u: must hold finite"):
        step.replace(tau_u=np.full(step.n_u, NAN))
    with pytest.raises(StepDataError, match=r"^M_u: must be positive definite"):
        step.replace(M_u=-step.M_u)
    with pytest.raises(StepDataError, match="d1, d2, n must be"):
        step.replace(contacts=replace(step.contacts, n=2 * step.contacts.n))


def test_steps_of_one_simulator_share_what_does_not_change():
    scenario = load_scenario("bunny_grasp", ["solver.certify=off"])  # its bunny is rigid
    simulator, q, results = scenario.simulator(), scenario.system.q_start, []
    for k in range(2):
        results.append(simulator.step(q, scenario.targets(0.01 * (k + 1))))
        q = results[-1].q
    one, two = (result.step for result in results)
    assert one.H is two.H
    assert one.counts is two.counts


def test_the_mass_matrix_of_a_mechanism_is_that_of_its_configuration(tmp_path):
    system, h = chain_scene(tmp_path), 0.01
    n_a, K_q = system.n_a, 500.0 * np.eye(system.n_a)
    simulator, q = Simulator(system, [], h=h, K_q=K_q), system.q_start
    matrices = []
    for _ in range(2):
        q = system.integrate(q, 0.1 * np.cos(np.arange(system.n_v)))
        step = simulator.step(q, system.q_start[: system.n_q_a]).step
        np.testing.assert_array_equal(step.M_u, system.M_u(q))
        expected = np.zeros((system.n_v, system.n_v))
        expected[:n_a, :n_a], expected[n_a:, n_a:] = h * K_q, system.M_u(q) / h
        np.testing.assert_array_equal(step.H, expected)
        matrices.append(step.M_u)
    assert (matrices[0] != matrices[1]).any()  # its un-actuated joints bend the arm


def test_sparse_contacts_are_read_like_contacts_and_keep_no_dense_jacobian(things):
    sparse = things["SparseContacts"]
    public = {name for name in dir(Contacts) if not name.startswith("_")}
    assert {*public, "J", "phi", "n", "d1", "d2", "name", "rows"} <= set(dir(sparse)) | set(
        vars(sparse)
    )
    assert sparse.J.shape == (sparse.n_c, 4, sparse.n_v)
    assert "J" not in vars(sparse)
    delta_q = np.sin(np.arange(sparse.n_v))
    np.testing.assert_allclose(sparse.dense().motion(delta_q), sparse.motion(delta_q), atol=1e-15)
    assert sparse.dense().dense() == sparse.dense()


REFUSED = {
    "blocks of other contacts": {"blocks": lambda b: replace(b, column=b.column[1:], J=b.J[1:])},
    "NaN in a block": {"blocks": lambda b: replace(b, J=np.full_like(b.J, NAN))},
    "columns that are no numbers": {"blocks": lambda b: replace(b, column=b.column + 0.5)},
    "n of length two": {"n": lambda n: 2 * n},
}


@pytest.mark.parametrize("changes", REFUSED.values(), ids=REFUSED)
def test_sparse_contacts_refuse(things, changes):
    sparse = things["SparseContacts"]
    assert isinstance(sparse, SparseContacts)
    with pytest.raises(StepDataError):
        replace(sparse, **{key: change(getattr(sparse, key)) for key, change in changes.items()})


def test_a_force_of_another_shape_is_refused(things):
    scenario = things["Scenario"]
    simulator, q, goal = scenario.simulator(), scenario.system.q_start, scenario.targets(0.01)
    with pytest.raises(StepDataError, match=r"force: must have shape \(8,\)"):
        simulator.step(q, goal, np.ones((8, 8)))


@pytest.mark.parametrize(
    ("settings", "field"),
    [({"h": 0.0}, "h"), ({"K_q": -np.eye(2)}, "K_q"), ({"K_q": np.eye(3)}, "K_q")],
    ids=str,
)
def test_a_simulator_refuses_what_no_step_may_have(things, settings, field):
    with pytest.raises(StepDataError) as caught:
        replace(things["Scenario"], **settings).simulator()
    assert caught.value.field == field


def test_pinching_twice_from_one_pickle_is_equal():
    step = pinch()
    assert pickle.loads(pickle.dumps(step)) == step
    moved = step.replace(contacts=changed(step.contacts, phi=step.contacts.phi + 1e-9))
    assert moved != step
