"""MuJoCo's compiler, in a process of its own: what it is given may end it, hang it or fill it.

The process is a program that is started, not a copy of this one, which may have threads. It prints
one line of JSON, and after it the model as MuJoCo's own binary file (MJB), in which each number has
the bits that were compiled; nothing that it prints is executed.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.model.urdf.urdf_file import MOST_LINKS, MOST_SHAPES
from quasistatic_ref.optional.mjcf.fence import Fence
from quasistatic_ref.optional.mjcf.geoms import touching
from quasistatic_ref.optional.mjcf.ignored import ignored_of_spec

if TYPE_CHECKING:
    from mujoco import MjModel

MODULE = "quasistatic_ref.optional.mjcf.compiler"
SECONDS = 8
"""Time of the processor that a compilation may take [s]: with the rest it is less than 10 s."""
PATIENCE = 60
"""Longest time of it by the clock [s]: others may be using the processor."""
MEMORY = 2 * 2**30
"""Largest memory of it [bytes]."""
ARENA = 2**20
"""Memory for contacts [bytes], of which none are computed here; by default it may be GiBs."""
SIMULATED = "simulated"
"""The argument by which a model keeps its memory for contacts."""
LARGEST_MODEL = 256 * 2**20
"""Largest model as a binary file [bytes]."""


def compiled(fence: Fence, simulated: bool = False) -> tuple[MjModel, list[str]]:
    """The model of a file as MuJoCo compiles it, and what of the file is ignored.

    Parameters
    ----------
    fence : Fence
    simulated : bool
        Whether MuJoCo is to simulate it: the model then has its own memory for contacts.

    Returns
    -------
    mujoco.MjModel
    list of str

    Raises
    ------
    ImportError
        If MuJoCo is not installed.
    ModelError
        If MuJoCo refuses the file, or needs more time or memory than it is given.
    """
    mujoco: ModuleType = import_module("mujoco")
    try:
        line, _, binary = printed(fence.path.resolve(), simulated).partition(b"\n")
    except subprocess.TimeoutExpired:
        raise fence.too_much(f"takes MuJoCo longer than {PATIENCE} s by the clock") from None
    except subprocess.CalledProcessError as ended:
        if ended.returncode == -signal.SIGXCPU:
            raise fence.too_much(f"takes MuJoCo longer than {SECONDS} s") from None
        raise fence.too_much(f"needs more than {MEMORY / 2**30:g} GiB, or ends MuJoCo") from None
    said = json.loads(line)
    if "refused" in said:
        raise fence.refusal(said["refused"])
    if "makes" in said:
        raise fence.too_much(f"makes {said['makes']}")
    return mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": binary}), said["ignored"]


def printed(path: Path, simulated: bool = False) -> bytes:
    """The answer of a process of its own."""
    more = [SIMULATED] if simulated else []
    return subprocess.run(
        [sys.executable, "-P", "-W", "ignore", "-m", MODULE, str(path), str(SECONDS), *more],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        # The same packages, and no memory that is only reserved, for threads.
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path), "OPENBLAS_NUM_THREADS": "1"},
        timeout=PATIENCE,
        check=True,
    ).stdout


def answer(path: Path, *simulated: str) -> bytes:
    """A line, and the model: what is ignored, and the time of the processor [s].

    Or a line that says why there is none.
    """
    mujoco: ModuleType = import_module("mujoco")
    # Without one, MuJoCo prints what it warns of, and writes MUJOCO_LOG.TXT where it is called.
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        return _compiled(mujoco, path, SIMULATED in simulated)
    except ValueError as error:
        return _line({"refused": str(error)})


def _compiled(mujoco: ModuleType, path: Path, simulated: bool) -> bytes:
    start = time.process_time()
    spec = mujoco.MjSpec.from_file(str(path))
    threads = spec.compiler.usethread
    memory = spec.memory
    spec.compiler.usethread = False
    spec.memory = memory if simulated else ARENA
    model = spec.compile()
    sizes = {
        "bodies": (model.nbody, MOST_LINKS),
        "geoms that touch": (int(touching(model).sum()), MOST_SHAPES),
        "bytes of a compiled model": (mujoco.mj_sizeModel(model), LARGEST_MODEL),
    }
    for what, (count, most) in sizes.items():
        if count > most:
            return _line({"makes": f"{count} {what}, more than {most}"})
    binary = np.empty((mujoco.mj_sizeModel(model), 1), np.uint8)
    mujoco.mj_saveModel(model, None, binary)
    spec.compiler.usethread = threads
    spec.memory = memory
    said = {"ignored": ignored_of_spec(spec), "seconds": time.process_time() - start}
    return _line(said) + binary.tobytes()


def _line(said: Mapping[str, object]) -> bytes:
    return json.dumps(said).encode() + b"\n"


def _limit(seconds: int) -> None:
    """Limit this process, also where its parent has ended; macOS limits no memory."""
    with suppress(ImportError, OSError, ValueError):
        resource: ModuleType = import_module("resource")
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


if __name__ == "__main__":
    _limit(int(sys.argv[2]))
    sys.stdout.buffer.write(answer(Path(sys.argv[1]), *sys.argv[3:]))
