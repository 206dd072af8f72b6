"""Nothing is claimed in a strange environment: modes of the processor, and threads.

Every call must end with the bits that it has in an ordinary thread, or be refused in a sentence.
"""

import ctypes
import platform
import threading
from collections import Counter
from contextlib import contextmanager
from copy import deepcopy
from functools import partial

import pytest

from quasistatic_ref import (
    InputError,
    QuasistaticError,
    load_scenario,
    rollout,
    solve_step,
    verify_answer,
)
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.choice import solver_for
from tests.made import bits
from tests.oracles.random_steps import drawn

STEP = drawn(1)
LONG = 20
"""Steps of a run by two threads."""

# Words of the processor's control register, by architecture: where fegetenv puts it, in 32 bits.
REGISTER = {"x86_64": 7, "aarch64": 0}
WORDS = {
    "x86_64": {"FTZ and DAZ": 0x8040, "upward": 0x4000},
    "aarch64": {"FTZ and DAZ": 1 << 24, "upward": 1 << 22},
}
MODES = WORDS[platform.machine()]
CAUSES = {"FTZ and DAZ": "flushes subnormal", "upward": "does not round to"}


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
    """A mode of the thread's arithmetic, such as ``"upward"``, within a block."""
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
    """What an outcome is, where `right` is that of an ordinary thread."""
    if isinstance(found, str) and found.startswith(REFUSED):
        return "refused"
    if found == right:
        return "same"
    gave_up = isinstance(found, str) and found.startswith(("unclaimed", "daqp did not solve"))
    return "unclaimed" if gave_up else f"broke: {found!r:.300}"


def proofs():
    """Calls that claim something of the step."""
    said = solve_step(STEP, NONE)
    kept = solver_for(STEP, "daqp")
    claims = said.certificate
    return [
        partial(solve_step, STEP, NONE),
        *(partial(solve_step, STEP, kept, certify=certify) for certify in ("full", "residual")),
        partial(verify_answer, STEP, said.delta_q, claims.active, claims=claims),
    ]


@pytest.mark.parametrize("name", MODES)
def test_in_a_mode_of_the_processor_nothing_is_claimed(name):
    """Solved by two ways and judged by residuals, and the proof verified; and solved "off"."""
    calls = [*proofs(), partial(solve_step, STEP, "daqp", certify="off")]
    with mode(name):
        words = Counter(word(outcome(call), None) for call in calls)
    assert words == Counter(refused=4, unclaimed=1)
    with mode(name), pytest.raises(InputError, match=CAUSES[name]):
        check_arithmetic()
    check_arithmetic()


def reply_and_leave(reply, name, *given):
    """A backend's reply, after which the thread is in a mode."""
    try:
        return reply(*given)
    finally:
        set_mode(control_word() | MODES[name])


@pytest.mark.parametrize("name", MODES)
def test_after_a_backend_that_leaves_a_mode_nothing_is_claimed(name):
    solver = solver_for(STEP, "daqp")
    solver.reply = partial(reply_and_leave, solver.reply, name)
    words = Counter()
    for certify in ("full", "residual", "off"):
        before = control_word()
        end = outcome(partial(solve_step, STEP, solver, certify=certify))
        set_mode(before)
        words[word(end, None)] += 1
    assert words == Counter(refused=2, unclaimed=1)


@pytest.mark.parametrize("shared", ["one simulator", "one system", "nothing"])
def test_a_step_next_to_another_thread_s_is_the_same_or_refused(shared):
    """A simulator that shares nothing is a deep copy: none of its steps is refused."""
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)  # it keeps more
    one = scenario.simulator()
    two = {"one simulator": one, "one system": scenario.simulator()}.get(shared, deepcopy(one))
    q = rollout(one, scenario.system.q_start, scenario.targets, LONG, record="light").q
    words = []
    ready = threading.Barrier(2)

    def steps(simulator, order):
        ready.wait()
        for k in order:
            end = outcome(lambda k=k: simulator.step(q[k], []).q)
            words.append(word(end, bits(q[k + 1])))

    there = threading.Thread(target=steps, args=(two, range(LONG)[::-1]))
    there.start()
    steps(one, range(LONG))
    there.join()
    counts = Counter(words)
    assert counts["same"] + counts["refused"] == 2 * LONG
    assert counts["same"] >= (2 * LONG if shared == "nothing" else LONG / 2)
