"""The program that compiles an MJCF file: MuJoCo and NumPy alone, so that it starts at once.

It is told which file, how many seconds and bytes it may use, and how large a model may be. It
prints one line of JSON, and after it the model as MuJoCo's own binary file (MJB), in which each
number has the bits that were compiled.
"""

from __future__ import annotations

import json
import sys
from contextlib import suppress
from importlib import import_module
from types import ModuleType

import mujoco
import numpy as np


def answer(path: str, most_bodies: int, most_bytes: int) -> bytes:
    """An empty JSON object and the model; or an object that says why there is none."""
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        spec = mujoco.MjSpec.from_file(path)
        spec.compiler.usethread = False
        model = spec.compile()
    except ValueError as error:
        return _line(refused=str(error))
    sizes = {
        "bodies": (model.nbody, most_bodies),
        "bytes of a compiled model": (mujoco.mj_sizeModel(model), most_bytes),
    }
    for what, (count, most) in sizes.items():
        if count > most:
            return _line(makes=f"{count} {what}, more than {most}")
    binary = np.empty((mujoco.mj_sizeModel(model), 1), np.uint8)
    mujoco.mj_saveModel(model, None, binary)
    return _line() + binary.tobytes()


def _line(**outcome: str) -> bytes:
    return json.dumps(outcome).encode() + b"\n"


def _limit(seconds: int, memory: int) -> None:
    """Limit this process, also where its parent has ended; macOS limits no memory."""
    with suppress(ImportError, OSError, ValueError):
        resource: ModuleType = import_module("resource")
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


if __name__ == "__main__":
    file, *limits = sys.argv[1:]
    seconds, memory, most_bodies, most_bytes = map(int, limits)
    _limit(seconds, memory)
    sys.stdout.buffer.write(answer(file, most_bodies, most_bytes))
