"""Replies as bytes between a solver's process and its keeper.

The keeper never unpickles what comes from there: the process belongs to the solver, and a pickle
can hold a program. A message is a line of JSON and float64 numbers.
"""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array

KEPT = 2
"""Programs that a solver's process keeps: one in raw and in natural units."""
HEAD = 1 << 16
"""Largest line of JSON [bytes]."""
NOTHING = Reply(None, None, False, "not called")
READY = "ready: "
"""What a worker says first, before the modes that its solver can be called in; else why it cannot
be called."""


class Unreadable(Exception):
    """A message that no worker of ours has written."""


@dataclass(frozen=True, eq=False)
class Response:
    """What a solver's process sends back for a request.

    Parameters
    ----------
    reply : Reply
        Of the last call.
    times : tuple of float
        Of every call [s], by the clock of that process.
    crashed : bool
        Whether an executable was ended by a signal.
    """

    reply: Reply
    times: tuple[float, ...] = ()
    crashed: bool = False


def to_bytes(response: Response, sizes: tuple[int, int]) -> bytes:
    """A message; arrays of other shapes than (n,) and (m,) are sent as their shapes alone."""
    reply = response.reply
    arrays = []
    shapes = []
    for array, size in zip((reply.x, reply.lam), sizes, strict=True):
        shapes.append(None if array is None else list(array.shape)[:8])
        if array is not None and array.shape == (size,):
            arrays.append(np.ascontiguousarray(array, dtype="<f8").tobytes())
    status = reply.status
    wanted = [[size] for size in sizes]
    if reply.solved and any(s not in (None, w) for s, w in zip(shapes, wanted, strict=True)):
        status = (
            f"x and z of shapes {shapes[0]} and {shapes[1]} in place of {wanted[0]} and {wanted[1]}"
        )
    head = {
        "shapes": shapes, "solved": bool(reply.solved), "status": status[:1000],
        "iterations": reply.iterations, "own": reply.own, "setup": reply.setup,
        "times": list(response.times), "crashed": response.crashed,
    }  # fmt: skip
    return b"\n".join([json.dumps(head).encode(), b"".join(arrays)])


def from_bytes(message: bytes, sizes: tuple[int, int]) -> Response:
    """What a message says.

    Raises
    ------
    Unreadable
        If it is not as :func:`to_bytes` writes it.
    """
    line, _, numbers = message.partition(b"\n")
    try:
        head = json.loads(line)
        arrays: list[Array | None] = []
        for shape, size in zip(head["shapes"], sizes, strict=True):
            array = None if shape is None else np.zeros((0, 0))  # a wrong shape
            if shape == [size]:
                array = np.frombuffer(numbers, "<f8", size).astype(np.float64)
                numbers = numbers[8 * size :]
            arrays.append(array)
        times = tuple(_time(t) for t in head["times"])
        own, setup = (None if (t := head[n]) is None else _time(t) for n in ("own", "setup"))
        iterations = None if head["iterations"] is None else int(head["iterations"])
        reply = Reply(arrays[0], arrays[1], head["solved"] is True, str(head["status"]), iterations,
                      own, times[-1] if times else 0.0, own, setup)  # fmt: skip
        return Response(reply, times, head["crashed"] is True)
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        raise Unreadable from None


def _time(value: Any) -> float:
    """A time [s]; less than nothing, as of a clock that was changed meanwhile, is nothing."""
    seconds = float(value)
    if not abs(seconds) < 1e9:
        raise ValueError
    return max(seconds, 0.0)
