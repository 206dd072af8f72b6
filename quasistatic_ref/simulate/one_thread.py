"""Steps by one thread at a time."""

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

from quasistatic_ref.errors import InputError

Step = TypeVar("Step", bound=Callable[..., Any])


def by_one_thread(step: Step) -> Step:
    """The same method of a simulator, refused while another thread takes a step of its system.

    Raises
    ------
    InputError
    """

    @wraps(step)
    def alone(simulator: Any, *given: Any, **named: Any) -> Any:
        lock = simulator.system.lock
        if not lock.acquire(blocking=False):
            problem = "another thread is taking a step of the same system; "
            problem += "give each thread a simulator of its own, which copy.deepcopy makes"
            raise InputError(problem, field="simulator")
        try:
            return step(simulator, *given, **named)
        finally:
            lock.release()

    return cast("Step", alone)
