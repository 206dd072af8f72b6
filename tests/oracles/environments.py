"""What surrounds a proof, made hostile: modes of the processor, and threads.

Every call must end with the bits that it has in an ordinary thread, or be refused in a sentence.
"""

import ctypes
import platform
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from functools import partial
from typing import Any

from quasistatic_ref import (
    QuasistaticError,
    Simulator,
    StepData,
    StepInfeasible,
    load_scenario,
    solve_step,
    verify,
)
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solver import solver_for
from tests.oracles.random_steps import mixed_step

LONG = 20
"""Steps of a run by two threads."""

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


def environment_of_floats() -> Any:
    """The floating-point environment of the thread, as fegetenv writes it."""
    found = (ctypes.c_uint32 * 8)()
    ctypes.CDLL(None).fegetenv(found)
    return found


def control_word() -> int:
    """The thread's control register."""
    return int(environment_of_floats()[REGISTER[platform.machine()]])


def set_mode(word: int) -> None:
    """Set the thread's control register.

    A word without the masks of exceptions, such as 0, must never be set: any operation may end the
    process then.
    """
    changed = environment_of_floats()
    changed[REGISTER[platform.machine()]] = word
    ctypes.CDLL(None).fesetenv(changed)


@contextmanager
def mode(name: str) -> Iterator[None]:
    """A mode of the thread's arithmetic, such as ``"FTZ"``, within a block."""
    before = control_word()
    set_mode(before | MODES[name])
    try:
        yield
    finally:
        set_mode(before)


Call = Callable[[], Any]
REFUSED = (
    "nothing can be proved in this thread",
    "simulator: another thread is using the same system",
)


def outcome(call: Call) -> Any:
    """What a call ends with: bits, the sentence of an error, or that nothing is claimed."""
    try:
        found = call()
    except QuasistaticError as error:
        return str(error)
    certificate = getattr(found, "certificate", None)
    return "unclaimed" if certificate and certificate.kind == "none" else bits(found)


def word(found: Any, right: Any) -> str:
    """The column of the table for an outcome, where `right` is that of an ordinary process."""
    if isinstance(found, str) and found.startswith(REFUSED):
        return "refused"
    if found == right:
        return "same"
    gave_up = isinstance(found, str) and found.startswith(("unclaimed", "daqp did not solve"))
    return "unclaimed" if gave_up else f"broke: {found!r:.300}"


def proofs(step: StepData) -> dict[str, Call]:
    """What claims something of a step."""
    calls = {"cold": partial(solve_step, step, NONE)}
    kept = solver_for(step, "daqp", fast=True)
    for certify in ("full", "residual"):
        calls[certify] = partial(solve_step, step, kept, certify=certify)
    try:
        said = solve_step(step, NONE)
        claims = said.certificate, said.delta_q, said.lam
        calls["verify"] = partial(verify, step, said.delta_q, claims[0].active, claims=claims[0])
    except StepInfeasible as proved:
        calls["farkas"] = partial(farkas_refutation, step, proved.farkas.exact)
    except QuasistaticError:
        pass  # ill-posed
    return calls


def in_mode(name: str, count: int) -> Counter[str]:
    """What claims something, and what does not, in a mode of the thread."""
    words = Counter()
    for seed in range(1, count + 1):
        step = mixed_step(seed)
        calls = proofs(step) | {"off": partial(solve_step, step, "daqp", certify="off")}
        with mode(name):
            words.update(word(outcome(call), None) for call in calls.values())
    return words


def left_by_backend(name: str, count: int) -> Counter[str]:
    """A mode that the backend leaves behind."""
    words = Counter()
    for seed in range(1, count + 1):
        solver = solver_for(step := mixed_step(seed), "daqp", fast=True)
        solver.reply = partial(reply_and_leave, solver.reply, name)  # type: ignore[method-assign]  # a planted fault
        for certify in ("full", "residual", "off"):
            before = control_word()
            found = outcome(partial(solve_step, step, solver, certify=certify))
            set_mode(before)
            words[word(found, None)] += 1
    return words


def reply_and_leave(reply: Callable[..., Any], name: str, *given: Any) -> Any:
    """A backend's reply, after which the thread is in a mode."""
    try:
        return reply(*given)
    finally:
        set_mode(control_word() | MODES[name])


def after_all_modes(count: int) -> Counter[str]:
    """Every mode set and reset: what solvers keep is as before."""
    words = Counter()
    for seed in range(1, count + 1):
        calls = proofs(mixed_step(seed))
        right = {key: outcome(call) for key, call in calls.items()}
        for name in MODES:
            with mode(name):
                for call in calls.values():
                    outcome(call)
        words.update(word(outcome(call), right[key]) for key, call in calls.items())
    return words


def next_to_a_mode(count: int) -> Counter[str]:
    """A mode of another thread, which is at work."""
    ended = threading.Event()

    def at_work() -> None:
        with mode(next(iter(MODES))):
            while not ended.is_set():
                sum(range(1000))

    other = threading.Thread(target=at_work)
    other.start()
    words = Counter()
    for seed in range(1, count + 1):
        calls = proofs(mixed_step(seed)).values()
        words.update(word(outcome(call), outcome(call)) for call in calls)
    ended.set()
    other.join()
    return words


def by_two_threads(kind: str, count: int) -> Counter[str]:
    """Two threads that take steps at once: with one simulator, two of a system, or a deep copy."""
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)  # it keeps more
    one = scenario.simulator()
    two = {"one simulator": one, "one system": scenario.simulator()}.get(kind, deepcopy(one))
    goals = [scenario.targets(scenario.h * (k + 1)) for k in range(LONG)]
    q = [scenario.system.q_start]
    for k in range(LONG):
        q.append(one.step(q[k], goals[k]).q)
    right = [bits(end) for end in q[1:]]
    words = []

    def steps(simulator: Simulator, order: range, ready: threading.Barrier) -> None:
        ready.wait()
        for k in order:
            found = outcome(lambda: simulator.step(q[k], goals[k]).q)  # noqa: B023 called at once
            words.append(word(found, right[k]))

    for _ in range(count):
        ready = threading.Barrier(2)
        there = threading.Thread(target=steps, args=(two, range(LONG)[::-1], ready))
        there.start()
        steps(one, range(LONG), ready)
        there.join()
    return Counter(words)
