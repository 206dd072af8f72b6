"""Nothing is claimed in a strange mode of the processor; threads take the same steps, or none."""

import ctypes
import platform
import threading
from collections import Counter
from contextlib import contextmanager
from copy import deepcopy
from functools import partial

import pytest

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.certify.certificate import verify
from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from tests.oracles.random_steps import mixed_step

STEP = mixed_step(1)
LONG = 20
"""Steps of a run that two threads take."""

# Words of the processor's control register, by architecture: where fegetenv puts it, in 32 bits.
REGISTER = {"x86_64": 7, "aarch64": 0}
WORDS = {
    "x86_64": {
        "FTZ": 0x8000, "DAZ": 0x40, "FTZ and DAZ": 0x8040,
        "downward": 0x2000, "upward": 0x4000, "toward zero": 0x6000,
    },
    "aarch64": {
        "FTZ and DAZ": 1 << 24, "upward": 1 << 22, "downward": 2 << 22, "toward zero": 3 << 22,
    },
}  # fmt: skip
MODES = WORDS[platform.machine()]


def environment_of_floats():
    """The floating-point environment of the thread, as fegetenv writes it."""
    found = (ctypes.c_uint32 * 8)()
    ctypes.CDLL(None).fegetenv(found)
    return found


def control_word():
    """The thread's control register."""
    return int(environment_of_floats()[REGISTER[platform.machine()]])


def set_mode(word):
    """Set the thread's control register.

    A word without the masks of exceptions, such as 0, must never be set: any operation may end the
    process then.
    """
    changed = environment_of_floats()
    changed[REGISTER[platform.machine()]] = word
    ctypes.CDLL(None).fesetenv(changed)


@contextmanager
def mode(name):
    """A mode of the thread's arithmetic, such as ``"FTZ"``, within a block."""
    before = control_word()
    set_mode(before | MODES[name])
    try:
        yield
    finally:
        set_mode(before)


REFUSED = (
    "nothing can be proved in this thread",
    "simulator: another thread is using the same system",
)


def outcome(call):
    """What a call ends with: bits, the sentence of an error, or that nothing is claimed."""
    try:
        found = call()
    except QuasistaticError as error:
        return str(error)
    certificate = getattr(found, "certificate", None)
    return "unclaimed" if certificate and certificate.kind == "none" else bits(found)


def word(found, right):
    """An outcome in a word, where `right` is that of an ordinary process."""
    if isinstance(found, str) and found.startswith(REFUSED):
        return "refused"
    if found == right:
        return "same"
    gave_up = isinstance(found, str) and found.startswith(("unclaimed", "daqp did not solve"))
    return "unclaimed" if gave_up else f"broke: {found!r:.300}"


def proofs(step):
    """What claims something of a step."""
    kept, said = solver_for(step, "daqp", fast=True), solve_step(step, NONE)
    claims = said.certificate
    return {
        "cold": partial(solve_step, step, NONE),
        "full": partial(solve_step, step, kept, certify="full"),
        "residual": partial(solve_step, step, kept, certify="residual"),
        "verify": partial(verify, step, said.delta_q, claims.active, claims=claims),
    }


def in_mode(name):
    """What claims something, and what does not, in a mode of the thread."""
    calls = proofs(STEP) | {"off": partial(solve_step, STEP, "daqp", certify="off")}
    with mode(name):
        return Counter(word(outcome(call), None) for call in calls.values())


def left_by_backend(name):
    """A mode that the backend leaves behind."""
    solver = solver_for(STEP, "daqp", fast=True)
    solver.reply = partial(reply_and_leave, solver.reply, name)
    words = Counter()
    for certify in ("full", "residual", "off"):
        before = control_word()
        found = outcome(partial(solve_step, STEP, solver, certify=certify))
        set_mode(before)
        words[word(found, None)] += 1
    return words


def reply_and_leave(reply, name, *given):
    """A backend's reply, after which the thread is in a mode."""
    try:
        return reply(*given)
    finally:
        set_mode(control_word() | MODES[name])


@pytest.mark.parametrize("name", MODES)
def test_in_a_mode_of_the_processor_nothing_is_claimed(name):
    """Solved by two ways and bounded, and its proof verified; and solved "off"."""
    assert in_mode(name) == Counter(refused=4, unclaimed=1)
    assert left_by_backend(name) == Counter(refused=2, unclaimed=1)
    cause = "flushes subnormal" if name in ("FTZ", "DAZ", "FTZ and DAZ") else "does not round to"
    with mode(name), pytest.raises(InputError, match=cause):
        check_arithmetic()
    check_arithmetic()


def test_what_solvers_keep_is_not_changed_by_a_mode():
    calls = proofs(STEP).values()
    right = [outcome(call) for call in calls]
    for name in MODES:
        with mode(name):
            for call in calls:
                outcome(call)
    assert [outcome(call) for call in calls] == right


def test_a_mode_of_another_thread_changes_nothing():
    calls = proofs(STEP).values()
    right = [outcome(call) for call in calls]
    begun, ended = threading.Event(), threading.Event()

    def at_work():
        with mode(next(iter(MODES))):
            begun.set()
            while not ended.is_set():
                sum(range(1000))

    other = threading.Thread(target=at_work)
    other.start()
    begun.wait()
    found = [outcome(call) for call in calls]
    ended.set()
    other.join()
    assert found == right


def by_two_threads(kind):
    """Two threads that take steps at once: with one simulator, two of a system, or a deep copy."""
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)  # it keeps more
    one = scenario.simulator()
    two = {"one simulator": one, "one system": scenario.simulator()}.get(kind, deepcopy(one))
    goals = [scenario.targets(scenario.h * (k + 1)) for k in range(LONG)]
    q = [scenario.system.q_start]
    for k in range(LONG):
        q.append(one.step(q[k], goals[k]).q)
    right = [bits(end) for end in q[1:]]
    words, ready = [], threading.Barrier(2)

    def steps(simulator, order):
        ready.wait()
        for k in order:
            found = outcome(lambda: simulator.step(q[k], goals[k]).q)  # noqa: B023 called at once
            words.append(word(found, right[k]))

    there = threading.Thread(target=steps, args=(two, range(LONG)[::-1]))
    there.start()
    steps(one, range(LONG))
    there.join()
    return Counter(words)


@pytest.mark.parametrize("shared", ["one simulator", "one system"])
def test_a_step_next_to_another_thread_s_is_the_same_or_refused(shared):
    words = by_two_threads(shared)
    assert set(words) <= {"same", "refused"}
    assert words.total() == 2 * LONG
    assert words["same"] >= LONG / 2


def test_deep_copies_take_steps_at_once():
    assert by_two_threads("a deep copy") == Counter(same=2 * LONG)
