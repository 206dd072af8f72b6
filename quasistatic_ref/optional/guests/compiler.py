"""MuJoCo's compiler, in a process of its own: a file may end it, hang it or fill the memory.

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
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.files.urdf.file import MOST_LINKS
from quasistatic_ref.optional.guests.fence import Fence
from quasistatic_ref.parts import needed_package

if TYPE_CHECKING:
    from mujoco import MjModel

MODULE = "quasistatic_ref.optional.guests.compiler"
SECONDS = 8
"""Time of the processor that a compilation may take [s]: with the rest it is less than 10 s."""
PATIENCE = 1200
"""Longest time of it by the clock [s], for what waits without using the processor."""
MEMORY = 2 * 2**30
"""Largest memory of it [bytes]."""
LARGEST_MODEL = 256 * 2**20
"""Largest model as a binary file [bytes]."""


def compiled_model(path: Path, roots: Sequence[str | Path] = ()) -> MjModel:
    """The model of an MJCF file as MuJoCo compiles it, with later warnings not printed.

    Parameters
    ----------
    path : Path
    roots : sequence of str or Path
        Folders from which the file may read besides its own.

    Raises
    ------
    InputError
        If MuJoCo is not installed.
    ModelError
        If MuJoCo refuses the file; if the file reads from elsewhere, or needs more time or memory
        than any robot: naming element and attribute.
    """
    fence = Fence(path, roots)
    mujoco = quiet_mujoco()
    try:
        line, _, binary = printed(path.resolve()).partition(b"\n")
    except subprocess.TimeoutExpired:
        raise fence.too_much(f"takes MuJoCo longer than {PATIENCE} s by the clock") from None
    except subprocess.CalledProcessError as ended:
        if ended.returncode == -signal.SIGXCPU:
            raise fence.too_much(f"takes MuJoCo longer than {SECONDS} s") from None
        raise fence.too_much(f"needs more than {MEMORY / 2**30:g} GiB, or ends MuJoCo") from None
    outcome = json.loads(line)
    if "allocate memory" in outcome.get("refused", ""):
        limit = f"the {MEMORY / 2**30:g} GiB that this package lets MuJoCo have"
        raise fence.too_much(f"needs more than {limit}")
    if "refused" in outcome:
        raise fence.refusal(outcome["refused"])
    if "makes" in outcome:
        raise fence.too_much(f"makes {outcome['makes']}")
    model: MjModel = mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": binary})
    return model


def quiet_mujoco() -> ModuleType:
    """MuJoCo's module, set to neither print warnings nor write MUJOCO_LOG.TXT."""
    mujoco = needed_package("mujoco", "engines", "MJCF")
    mujoco.set_mju_user_warning(lambda text: None)
    return mujoco


def printed(path: Path) -> bytes:
    """What :func:`answer` gives for a MuJoCo file, computed in a separate process."""
    return subprocess.run(
        [sys.executable, "-P", "-W", "ignore", "-m", MODULE, str(path), str(SECONDS)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        # The same packages, and no memory that is only reserved, for threads.
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path), "OPENBLAS_NUM_THREADS": "1"},
        timeout=PATIENCE,
        check=True,
    ).stdout


def answer(path: Path) -> bytes:
    """An empty JSON object and the model; or an object that says why there is none."""
    mujoco = quiet_mujoco()
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        spec.compiler.usethread = False
        model = spec.compile()
    except ValueError as error:
        return _line(refused=str(error))
    sizes = {
        "bodies": (model.nbody, MOST_LINKS),
        "bytes of a compiled model": (mujoco.mj_sizeModel(model), LARGEST_MODEL),
    }
    for what, (count, most) in sizes.items():
        if count > most:
            return _line(makes=f"{count} {what}, more than {most}")
    binary = np.empty((mujoco.mj_sizeModel(model), 1), np.uint8)
    mujoco.mj_saveModel(model, None, binary)
    return _line() + binary.tobytes()


def _line(**outcome: str) -> bytes:
    return json.dumps(outcome).encode() + b"\n"


def _limit(seconds: int) -> None:
    """Limit this process, also where its parent has ended; macOS limits no memory."""
    with suppress(ImportError, OSError, ValueError):
        resource: ModuleType = import_module("resource")
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


if __name__ == "__main__":
    _limit(int(sys.argv[2]))
    sys.stdout.buffer.write(answer(Path(sys.argv[1])))
