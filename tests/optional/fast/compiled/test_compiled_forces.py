"""Forces of single contacts from C against those of the core: equal bits."""

import copy
import pickle
from fractions import Fraction
from threading import Event, Lock, Thread

import numpy as np
import pytest

from quasistatic_ref import RunFailed, Simulator, contact_forces, load_scenario
from quasistatic_ref.lab.bench.scenes import Boxes
from quasistatic_ref.optional.fast import rechecked
from quasistatic_ref.optional.fast.compiled import forces
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.rows_given import SQUARES, half_way_forces
from validation.make.confirmed_bits import random_case
from validation.make.degenerate_bits import degenerate_step

pytestmark = needs_compiler


def in_c(step):
    return forces.Forces(step).in_c(step)


def test_forces_of_random_and_of_degenerate_steps_have_the_bits_of_the_core():
    """Cones of other corners than the pyramid's are left to the core."""
    known = forces.knows
    steps = [make(seed) for seed in range(30) for make in (degenerate_step, mixed_step)]
    decided = 0
    for step in filter(lambda step: known(step.cone), steps):
        wrench, left = in_c(step)
        decided += not left
        if not left:
            near = np.zeros(step.n_v), np.zeros_like(wrench)
            assert wrench.tobytes() == contact_forces(step, near=near).wrench.tobytes()
    assert decided > 0.85 * len(steps) / 2


def mixed_step(seed):
    return random_case(seed)[1]


def test_forces_of_boxes_in_a_row_have_the_bits_of_the_core():
    """Nothing acts across the row: what is zero there is shown without what acts along it."""
    boxes = Boxes(np.full((3, 3), 0.02), np.full(3, 0.2))
    system = boxes.system(np.array([[0.04 * i, 0.0, 0.02] for i in range(3)]))
    pairs = boxes.pairs(system, range(3), [(0, 1), (1, 2)])
    simulator = Simulator(system, pairs, h=0.02, K_q=0.0, fast=True)
    push = np.zeros(system.n_v)
    push[0] = 4.0
    step = simulator.step(system.q_start, np.zeros(0), push).solution.step
    wrench, left = in_c(step)
    assert not left
    near = np.zeros(step.n_v), np.zeros_like(wrench)
    assert wrench.tobytes() == contact_forces(step, near=near).wrench.tobytes()
    assert (wrench == 0.0).sum() > wrench.size / 3


def test_a_force_half_way_between_two_float64_is_rounded_to_even():
    """The force of a contact is load SQUARES 2^-16: of 54 bits, the last of which is one."""
    load = 2**39 + 5
    right = [Fraction(load * square, 2**16) for square in SQUARES]
    wrench, left = in_c(half_way_forces(float(load)))
    assert not left
    assert wrench[:, 2].tolist() == [float(force) for force in right]
    assert [force == Fraction(float(force)) for force in right] == [False, False, False, True]


def test_a_force_that_is_hardly_off_the_middle_of_two_float64_is_left_to_the_core():
    assert in_c(half_way_forces(2.0**39 + 5.0, gap=2.0**-300))[1] == [0]


def test_a_full_record_of_fast_holds_the_forces_of_the_plain_path():
    pinch = ["steps=12"]
    fast = load_scenario("two_finger_pinch", pinch, fast=True).run(progress=False)
    plain = load_scenario("two_finger_pinch", pinch).run(progress=False)
    assert "forces" not in plain.arrays
    assert fast.arrays["forces"].tobytes() == plain.forces.tobytes()
    assert np.abs(plain.forces).max() > 4.0  # [N]


def block_of(name, steps):
    """A few steps of a scenario that C takes at once, after its first one."""
    scenario = load_scenario(name, fast=True)
    simulator = scenario.simulator()
    goal = scenario.system.q_start[: scenario.system.n_q_a]
    simulator.step(scenario.system.q_start, goal)
    given = goal, np.zeros(scenario.system.n_v)
    block = simulator.steps(scenario.system.q_start, lambda k, q: given, steps)
    assert len(block) == steps
    return block, np.array([result.solution.wrench for result in block])


@pytest.mark.parametrize("name", ["stack", "two_finger_pinch", "block_incline"])
def test_forces_of_a_block_are_those_of_each_of_its_steps(name):
    block, near = block_of(name, 4)
    found = block.forces(near)
    assert found.any()
    for result, own in zip(block, found, strict=True):
        assert own.tobytes() == contact_forces(result.step).wrench.tobytes()


def test_what_c_leaves_open_of_a_block_comes_from_the_core(monkeypatch):
    block, near = block_of("stack", 3)
    right = block.forces(near)
    of_block = forces.Forces.of_block

    def opened(self, first, records, near):
        wrench, code = of_block(self, first, records, near)
        wrench[1] = np.nan
        code[1, -1] = 1
        return wrench, code

    monkeypatch.setattr(forces.Forces, "of_block", opened)
    assert block.forces(near).tobytes() == right.tobytes()


def test_wrong_forces_of_a_block_are_noticed_and_no_run_holds_them(monkeypatch):
    """The record is formed when the run has ended; no part of it is kept."""
    of_block = forces.Forces.of_block

    def wrong(*given):
        wrench, code = of_block(*given)
        return wrench + 1.0, code

    monkeypatch.setattr(forces.Forces, "of_block", wrong)
    monkeypatch.setitem(rechecked._proofs, rechecked.FORCES, rechecked.EVERY - 3)
    with pytest.raises(RunFailed, match="proved a step wrongly: a force is not what") as failed:
        load_scenario("stack", steps=20, fast=True).run(progress=False)
    trajectory = failed.value.trajectory
    assert len(trajectory) == len(trajectory.t) == 0
    assert len(trajectory.q) == 1


def test_forces_of_a_block_in_which_other_coordinates_move_a_contact_are_those_of_each_step():
    block, near = block_of("stack", 3)
    right = block.forces(near)
    records = block._records.copy()
    records["scene"]["J"][1] = 0.0
    of_steps = forces.ForcesOfSteps()
    assert of_steps.of_block(block, records, near).tobytes() == right.tobytes()


def test_forces_of_two_solutions_may_be_read_in_two_threads(monkeypatch):
    """The second one's data are written before C forms the forces of the first, or it waits."""
    came = Event()

    class Watched:
        def __init__(self):
            self.lock = Lock()

        def __enter__(self):
            if not self.lock.acquire(blocking=False):
                came.set()
                self.lock.acquire()

        def __exit__(self, *_):
            self.lock.release()

    monkeypatch.setattr(forces, "Lock", Watched, raising=False)
    scenario = load_scenario("stack", fast=True)
    simulator = scenario.simulator()
    one = simulator.step(scenario.system.q_start, np.zeros(0))
    two = simulator.step(one.q, np.zeros(0))
    right = [in_c(each.solution.step)[0] for each in (one, two)]
    assert (right[0] != right[1]).any()
    of_steps = forces.ForcesOfSteps()
    found = []

    def read(result):
        near = result.solution.delta_q, result.solution.wrench
        found.append(of_steps.wrench(result.solution.step, near))

    other = Thread(target=read, args=(two,))
    write_data = forces.write_data

    def written(s, step):
        write_data(s, step)
        if step is one.solution.step:
            other.start()
            came.wait(60)
        came.set()

    monkeypatch.setattr(forces, "write_data", written)
    read(one)
    other.join()
    assert sorted(each.tobytes() for each in found) == sorted(each.tobytes() for each in right)


def test_a_copy_of_a_solution_has_its_forces_from_c_where_there_is_c(monkeypatch):
    scenario = load_scenario("block_incline", fast=True)
    result = scenario.simulator().step(scenario.system.q_start, np.zeros(0))
    copied = [pickle.loads(pickle.dumps(result.solution)), copy.deepcopy(result.solution)]
    asked = []
    write_data = forces.write_data
    monkeypatch.setattr(forces, "write_data", lambda *given: asked.append(write_data(*given)))
    for k, one in enumerate(copied, start=1):
        assert one == result.solution
        assert one.forces.tobytes() == result.forces.tobytes()
        assert len(asked) >= k
    monkeypatch.setattr(forces, "why_not", lambda: "there is no compiler")
    elsewhere = pickle.loads(pickle.dumps(result.solution))
    asked.clear()
    assert elsewhere.forces.tobytes() == result.forces.tobytes()
    assert not asked
