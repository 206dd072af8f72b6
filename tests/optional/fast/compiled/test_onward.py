"""Steps that follow on each other, in few calls: those of the long way, to the last bit."""

import pickle
import time
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import InputError, RunFailed, Simulator, load_scenario, rollout
from quasistatic_ref.errors import LimitExceeded
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.lab.bench.scenes import cubes
from quasistatic_ref.optional.fast import rechecked
from quasistatic_ref.optional.fast.adapters.daqp import Daqp
from quasistatic_ref.optional.fast.compiled import onward as onward_module
from quasistatic_ref.optional.fast.rechecked import WHOLE, WrongProof
from quasistatic_ref.optional.fast.simulator import FastSimulator
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.solve.units import DenseStepInBothUnits, in_si
from quasistatic_ref.tolerances import ILL_POSED
from tests.closeness import assert_close, assert_within
from tests.optional.fast.compiled.test_fast import (
    all_of,
    differing_names,
    needs_compiler,
    scene,
    two_steps,
)

pytestmark = needs_compiler
UNCERTIFIED = ["solver.certify=off", "record=light"]
ROUNDING = 1e-13
"""Of residuals: sums of 100 products near one, in two orders."""


def long_way(simulator):
    """The same simulator, which takes each step in Python, and asks the backend."""
    simulator.taken = lambda q, given, most: ()
    return simulator


def results(scenario, simulator, steps=12):
    q = scenario.system.q_start
    for k in range(steps):
        result = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
        q = result.q
        yield result


@pytest.fixture(autouse=True)
def _no_proof_is_due(monkeypatch):
    monkeypatch.setitem(rechecked._proofs, WHOLE, 1)


@pytest.fixture
def few(monkeypatch):
    """How many steps C takes in each block, and how many it leaves."""
    found = []
    plain = FastSimulator.taken

    def watched(*arguments):
        taken = plain(*arguments)
        found.append(len(taken))
        return taken

    monkeypatch.setattr(FastSimulator, "taken", watched)
    return found


@pytest.mark.parametrize("name", ["bunny_grasp", "stack"])
def test_runs_of_which_nothing_is_claimed_have_the_bits_of_the_long_way(few, name):
    scenario = load_scenario(name, UNCERTIFIED, fast=True)
    ways = scenario.simulator(), long_way(scenario.simulator())
    for one, other in zip(*(results(scenario, way) for way in ways), strict=True):
        assert one == other
        assert one.solution.statistics._replace(solve_time=0.0) == (
            other.solution.statistics._replace(solve_time=0.0)
        )
    assert few == [1] * 12


@pytest.mark.parametrize(
    "name",
    ["bunny_grasp", "block_push", pytest.param("panda_push", marks=pytest.mark.extra("robots"))],
)
def test_proofs_on_the_rows_of_the_step_before_have_the_bits_of_the_long_way(few, name):
    scenario = load_scenario(name, ["record=light"], fast=True)
    ways = scenario.simulator(), long_way(scenario.simulator())
    for one, other in zip(*(results(scenario, way, 40) for way in ways), strict=True):
        assert differing_names(all_of(one), all_of(other)) == []
        mine, its = (each.solution.certificate.residuals for each in (one, other))
        assert [*mine] == [*its]
        assert max(mine.values()) < ROUNDING
    assert few == [1] * 40  # the first from no rows


def test_wrenches_of_a_scenario_go_in_blocks_and_functions_of_a_user_by_themselves(few):
    scenario = load_scenario("sphere_spin", ["record=light"], steps=40, fast=True)
    run = scenario.run(progress=False)
    assert few == [1, 39]
    few.clear()
    force = scenario.force
    alone = rollout(scenario.simulator(), scenario.system.q_start, scenario.targets, 40,
                    force=lambda t, q: force(t, q), record="light", progress=False)  # fmt: skip
    assert few == [1] * 40
    for key in ("q", "delta_q", "wrench"):
        assert run[key].tobytes() == alone[key].tobytes()


@pytest.mark.parametrize("certify", ["off", "full"])
def test_parts_of_a_result_are_made_when_they_are_asked_for(few, certify):
    """So a loop that reads q alone takes two thirds of the time; a copy has all of them."""
    scenario = load_scenario("bunny_grasp", [f"solver.certify={certify}"], fast=True)
    simulator = scenario.simulator()
    *_, result = results(scenario, simulator, 3)
    assert not {"step", "solution", "points", "seconds"} & {*vars(result)}
    copied = pickle.loads(pickle.dumps(result))
    assert copied == result
    laps = simulator.onward._s["seconds"]  # of the last step
    assert [*copied.seconds.values()] == [*result.seconds.values()] == laps.tolist()
    assert not {"simulator", "solver", "record"} & {*vars(copied)}
    assert few[-1] == 1


class Every(Observer):
    """Has a run stop at each step."""

    every_step = True


class Times:
    """A target, and how often it was asked for each step."""

    def __init__(self, scenario, fails_at=np.inf):
        self.scenario = scenario
        self.fails_at = fails_at
        self.asked = []

    def __call__(self, t, q):
        """The target, unless it fails."""
        self.asked.append(round(t / self.scenario.h) - 1)
        if self.asked[-1] == self.fails_at:
            raise InputError("is wrong on purpose", field="target")
        return self.scenario.targets(t)


def run_of(scenario, steps, target=None, **more):
    return rollout(
        scenario.simulator(), scenario.system.q_start, target or scenario.targets, steps,
        record=scenario.record, progress=False, **more,
    )  # fmt: skip


def same(one, other, steps):
    """Whether two runs have the same first steps."""
    return all(bits(one[name][:steps]) == bits(other[name][:steps]) for name in one.arrays)


@pytest.mark.parametrize("settings", [["record=full"], UNCERTIFIED], ids=["proved", "off"])
def test_blocks_have_the_bits_of_single_steps_however_a_run_ends(few, tmp_path, settings):
    scenario = load_scenario("bunny_grasp", [*settings, "steps=24"], fast=True)
    whole = run_of(scenario, 24)
    assert few == [1, 23]  # one is compared
    single = run_of(scenario, 24, observers=[Every()])
    assert same(single, whole, 25)
    assert same(run_of(scenario, 9), whole, 9)
    times = Times(scenario)
    assert same(run_of(scenario, 24, times), whole, 25)
    assert times.asked == [*range(24)]
    with pytest.raises(RunFailed, match=r"step 17: .*wrong on purpose") as failed:
        run_of(scenario, 24, Times(scenario, 17), save=tmp_path / "run.npz", save_every=60)
    assert failed.value.trajectory.steps == 17
    assert same(failed.value.trajectory, whole, 17)


def test_a_target_may_take_steps_with_the_same_simulator(few):
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    simulator = scenario.simulator()

    def tried(t, q):
        simulator.step(q, scenario.targets(t + scenario.h))
        return scenario.targets(t)

    q = scenario.system.q_start
    run = rollout(simulator, q, tried, 6, record="light", progress=False)
    assert bits(run["q"]) == bits(run_of(scenario, 6)["q"])
    assert few[:12] == [1] * 12


def test_interrupted_blocks_go_on_with_the_rows_of_the_last_step(few, tmp_path, monkeypatch):
    """What a run is resumed by is the saved lam: no step is asked for again."""
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    whole = run_of(scenario, 120)
    path = tmp_path / "run.npz"

    def noting(t, q):
        if round(t / scenario.h) == 50:
            interrupt.noted = True
        return scenario.targets(t)

    from quasistatic_ref.simulate import rollout as module

    class Noted(module.Interrupt):
        def __init__(self):
            nonlocal interrupt
            super().__init__()
            interrupt = self

    interrupt = None
    monkeypatch.setattr(module, "Interrupt", Noted)
    with pytest.raises(RunFailed, match="step 50: interrupted") as ended:
        run_of(scenario, 120, noting, save=path, save_every=0.001)
    assert same(ended.value.trajectory, whole, 50)
    monkeypatch.setattr(Daqp, "reply", None)  # it is not asked
    resumed = run_of(scenario, 120, save=path, resume=True)
    assert same(resumed, whole, 121)


def test_a_limit_ends_a_block_at_the_step_that_it_ends(few):
    settings = ["record=light", "limits.reach=0.205", "steps=200"]
    scenario = load_scenario("bunny_grasp", settings, fast=True)
    ends = []
    for observers in ((), [Every()]):
        with pytest.raises(RunFailed) as failed:
            run_of(scenario, 200, observers=observers)
        ends.append((str(failed.value), failed.value.trajectory))
    (said, one), (other_said, other) = ends
    assert "limits.reach" in said
    assert said == other_said
    assert one.steps > 100
    assert few.count(0) == 1  # the last step, which a block has left open, once
    assert same(one, other, one.steps + 1)


def test_a_block_ends_before_a_proof_that_is_checked(monkeypatch):
    """Every seventh proof is: that of step 6, since step 1 is proved twice, and compared."""
    scenario = load_scenario("bunny_grasp", ["record=light", "steps=12"], fast=True)
    monkeypatch.setattr(rechecked, "EVERY", 7)
    monkeypatch.setitem(rechecked._proofs, WHOLE, 0)

    def checked(step, found):
        if rechecked._proofs[WHOLE] > 1:
            raise WrongProof(step, "all of it")

    monkeypatch.setattr(onward_module, "check", checked)
    with pytest.raises(RunFailed, match=r"step 6: .*all of it") as failed:
        scenario.run(progress=False)
    assert failed.value.trajectory.steps == 6


def test_a_step_in_which_others_move_contacts_is_divided_anew(few):
    scenario = load_scenario("stack", ["record=light", "steps=8"], fast=True)
    whole = run_of(scenario, 8)
    simulator = scenario.simulator()
    run = list(results(scenario, simulator, 4))
    before = simulator.onward
    before._s.integers("moves")[0, 0] ^= 1  # as if it had been otherwise
    run.append(simulator.step(run[-1].q, scenario.targets(5 * scenario.h)))
    assert simulator.onward is not before
    assert bits(np.array([result.q for result in run])) == bits(whole["q"][1:6])
    assert few[2:] == [1] * 5


def proved_groups(folder):
    """What has proved two steps of bodies of all kinds; each proof and the last step of it."""
    simulator = Simulator(**scene("the cone pyramid", folder), fast=True)
    *_, [last] = two_steps([simulator], simulator.system.q_start)
    onward = simulator.onward
    whole = DenseStepInBothUnits(last.step)
    both = [part.in_both_units(whole) for part in onward.solver.prover.proofs.parts]
    return onward, [*zip(onward.prover.proofs, both, strict=True)]


def verdict(onward):
    """Whether C takes the answers that its proofs hold; their residuals."""
    records = np.empty(1, onward.record)
    onward.begin(records, None)
    taken = onward._proved(onward._address) != onward_module.TO_PYTHON
    return taken, onward._s["residuals"].copy()


def test_residuals_of_any_answer_are_those_of_the_core(tmp_path, rng):
    onward, groups = proved_groups(tmp_path)
    for proof, both in groups:
        names = ("delta_q", "lam")
        right = [proof.s[name].copy() for name in names]
        for _ in range(8):
            natural = [rng.normal(size=len(array)) for array in right]
            for name, array in zip(names, in_si(*natural, both.units), strict=True):
                proof.s[name][:] = array
            expected = both.natural_residuals(*natural)
            assert_close(verdict(onward)[1], [*vars(expected).values()], ROUNDING)
        for name, array in zip(names, right, strict=True):
            proof.s[name][:] = array
    taken, small = verdict(onward)
    assert taken
    assert small.max() < ROUNDING


MOST = ILL_POSED / 8
"""Of ||delta_q||_H over ||H^-1 g||_H that C takes [-]."""
ONE = [[1.0, 0.0], [0.0, 1.0]]
ANSWERS = {
    "at rest": ([0.0, 0.0], [0.0, 0.0], ONE, True),
    "hardly short enough": ([0.999999 * MOST, 0.0], [1.0, 0.0], ONE, True),
    "hardly too long": ([1.000001 * MOST, 0.0], [1.0, 0.0], ONE, False),
    # (1, 2) H^-1 (1, 2)' = 9, where 1 (1 + 1) 1 + 2 (1 + 1) 2 = 10
    "too long for a coupled load": ([3.1 * MOST, 0.0], [1.0, 2.0], [[1.0, 1.0]] * 2, False),
    "moved without a load, by what vanishes squared": ([1e-170, 0.0], [0.0, 0.0], ONE, False),
    "loads whose squares are small": ([1e-132, 0.0], [1e-132, 0.0], ONE, False),
    "loads of which rounding may be all": (
        [1e-15, 0.0], [1.0, 1 - 2.0**-24], [[1.0, -1.0], [-1.0, 1.0]], False,
    ),
}  # fmt: skip
"""delta_q, g and H^-1 of two coordinates whose H is one; whether C takes them."""


def test_answers_that_may_be_too_long_for_their_loads_or_no_numbers_are_left_to_python(tmp_path):
    onward, groups = proved_groups(tmp_path)
    s, h = next((proof.s, one.si_step.h) for proof, one in groups if not one.si_step.n_a)
    n = s.number("n_v")
    inverse = np.zeros((n, n))
    s["lam"][:] = 0.0
    s.put({"inverse": inverse, "M_u": h * np.eye(n)})
    s["delta_q"][:] = s["g"][:] = 0.0
    for words, (delta_q, g, of_two, taken) in ANSWERS.items():
        s["delta_q"][:2] = delta_q
        s["g"][:2] = g
        inverse[:2, :2] = of_two
        assert verdict(onward)[0] == taken, words
    s["delta_q"][:] = s["g"][:] = 0.0
    for array, wrong in ((s["b"], np.nan), (s["M_u"], np.nan), (onward._s["lam"], 2.0**100)):
        right = array.flat[0]
        array.flat[0] = wrong
        assert not verdict(onward)[0]
        array.flat[0] = right
    assert verdict(onward)[0]


def test_targets_whose_angles_are_open_in_c_are_left_to_python(tmp_path, rng):
    """Where the float64 next to an angle is in doubt: one of some 60 numbers."""
    simulator = Simulator(**scene("the cone pyramid", tmp_path), fast=True)
    system = simulator.system
    q = system.q_start
    left = 0
    for _ in range(100):
        goal = system.integrate(q, 1e-3 * rng.normal(size=system.n_v))[: system.n_q_a]
        result = simulator.step(q, goal)
        left += not isinstance(result, onward_module.FollowingResult)
        assert bits(result.step.delta_q_bar_a) == bits(system.actuated_difference(q, goal))
    assert left


def fails(reply):
    reply.solved = False
    reply.status = "on purpose"


def is_not_finite(reply):
    reply.x[0] = np.nan


def has_a_multiplier_that_is_not_finite(reply):
    reply.lam[0] = np.inf


def has_no_multipliers(reply):
    reply.lam = None


def raises(reply):
    raise RuntimeError("on purpose")


@pytest.mark.parametrize(
    "wrong",
    [fails, is_not_finite, has_a_multiplier_that_is_not_finite, has_no_multipliers, raises],
)
def test_an_answer_that_will_not_do_is_left_to_the_long_way(few, monkeypatch, wrong):
    """The next reply of the backend is right again, and so is what the step comes to."""
    scenario = load_scenario("bunny_grasp", UNCERTIFIED, fast=True)
    expected = [result.q for result in results(scenario, scenario.simulator(), 8)]
    plain = Daqp.reply
    calls = []

    def once(self, same_H, warm):
        reply = plain(self, same_H, warm)
        calls.append(reply)
        if len(calls) in (6, 7):  # and its second, cold attempt
            wrong(reply)
        return reply

    monkeypatch.setattr(Daqp, "reply", once)
    del few[:]
    run = list(results(scenario, scenario.simulator(), 8))
    assert 0 in few[3:]
    for result, q in zip(run, expected, strict=True):
        assert_within(result.q, q, 1e-9)  # cold, and so not the same bits


@pytest.mark.parametrize("backend", ["piqp", "quadprog"])
def test_backends_that_need_a_guard_take_the_long_way(few, backend):
    """Rows out of reach hurt one, and the other may not return."""
    scenario = load_scenario("bunny_grasp", [*UNCERTIFIED, f"solver.backend={backend}"], fast=True)
    assert len(list(results(scenario, scenario.simulator(), 3))) == 3
    assert few == [0, 0, 0]


def test_boxes_that_nothing_couples_follow_in_blocks(few):
    """Of 18, J is kept without its zeros; 108 coordinates are five parts of the workspace."""
    made = cubes(18, 1, 6, "askew")
    simulator = made.simulator("full", True)
    assert simulator.blocks is not None
    assert len(simulator.system.workspace().parts) == 5
    q = simulator.step(made.q, made.goals[0], made.force).q
    block = simulator.steps(q, lambda k, q: (made.goals[0], made.force), 3)
    motion = [one.step.contacts.motion(one.solution.delta_q) for one in block]
    assert bits(block.arrays["motion"]) == bits(np.array(motion))
    assert few == [1, 3]
    kinematics = simulator.system.kinematics(q)  # a resumed run poses its steps so
    points = simulator.closest_points(kinematics)
    again = simulator.step_data(q, made.goals[0], made.force, points, kinematics)
    assert bits([again.contacts.J, again.tau_u]) == bits(
        [block[0].step.contacts.J, block[0].step.tau_u]
    )


def test_nothing_is_claimed_where_arithmetic_is_not_that_of_proofs(few, monkeypatch):
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    simulator = scenario.simulator()
    *_, last = results(scenario, simulator, 3)

    def changed():
        raise InputError("numbers are not those of IEEE 754", field="arithmetic")

    monkeypatch.setattr(onward_module, "check_arithmetic", changed)
    with pytest.raises(InputError, match="not those of IEEE 754"):
        simulator.step(last.q, scenario.targets(4 * scenario.h))


def test_an_extension_that_is_given_late_is_asked():
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    simulator = scenario.simulator()
    *_, last = results(scenario, simulator, 3)

    def asked(q):
        raise InputError("is asked", field="extension")

    simulator.extension = asked
    with pytest.raises(InputError, match="extension: is asked"):
        simulator.step(last.q, scenario.targets(4 * scenario.h))


def test_a_step_from_too_deep_is_refused_in_the_words_of_the_plain_path(few):
    said = []
    for fast in (False, True):
        scenario = load_scenario("block_push", ["record=light"], fast=fast)
        simulator = scenario.simulator()
        *_, last = results(scenario, simulator, 3)
        sunk = scenario.system.placed({"block": {"xyz": [0, 0, -0.06]}}, last.q)
        with pytest.raises(LimitExceeded) as refused:
            simulator.step(sunk, scenario.targets(4 * scenario.h))
        said.append(str(refused.value))
    assert "deeper than limits.penetration" in said[0]
    assert said[1] == said[0]
    assert few == [1, 1, 1, 0]


def test_laps_are_of_the_step_alone():
    """A target that sleeps is no part of a step; a proof on the last rows asks no backend."""
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    run = rollout(
        scenario.simulator(), scenario.system.q_start,
        lambda t, q: time.sleep(0.05) or scenario.targets(t), 4, progress=False,
    )  # fmt: skip
    assert sum(seconds[3] for seconds in run.seconds.values()) < 0.05
    assert {name for name, seconds in run.seconds.items() if not seconds[3] > 0} == {"solve"}


def test_a_first_step_that_follows_wrongly_is_the_last(few, monkeypatch):
    """C that gives another q+: the long way takes all steps."""
    scenario = load_scenario("bunny_grasp", ["record=light"], fast=True)
    right = [one.q for one in results(scenario, long_way(scenario.simulator()), 6)]
    taken = FastSimulator.taken

    def wrong(*arguments):
        return [replace(one, q=one.q + 1e-12) for one in taken(*arguments)]

    monkeypatch.setattr(FastSimulator, "taken", wrong)
    assert bits([one.q for one in results(scenario, scenario.simulator(), 6)]) == bits(right)
    assert few == [1, 0, 0, 0, 0, 0]
