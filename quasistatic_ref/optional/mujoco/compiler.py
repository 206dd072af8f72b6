"""MuJoCo's compiler, in a process of its own: a file may end it, hang it or fill the memory.

The process is a program that is started, not a copy of this one, which may have threads; nothing
that it prints is executed.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from quasistatic_ref.files.urdf.file import MOST_LINKS
from quasistatic_ref.optional.mujoco.fence import Fence
from quasistatic_ref.parts import needed_package

if TYPE_CHECKING:
    from mujoco import MjModel

PROGRAM = "quasistatic_ref.optional.mujoco.compilation"
SECONDS = 8
"""Time of the processor that a compilation may take [s]: with the rest it is less than 10 s."""
PATIENCE = 1200
"""Longest time of it by the clock [s], for what waits without using the processor."""
MEMORY = 2 * 2**30
"""Largest memory of it [bytes]."""
LARGEST_MODEL = 256 * 2**20
"""Largest model as a binary file [bytes]."""
SURROUNDINGS = {"OPENBLAS_NUM_THREADS": "1", "MUJOCO_GL": "off"}
"""No memory that is only reserved, for threads; and no libraries that draw."""


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
    """What :func:`.compilation.answer` gives for a MuJoCo file, computed in a separate process."""
    limits = map(str, (SECONDS, MEMORY, MOST_LINKS, LARGEST_MODEL))
    return subprocess.run(
        [sys.executable, "-P", "-W", "ignore", "-m", PROGRAM, str(path), *limits],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | SURROUNDINGS | {"PYTHONPATH": os.pathsep.join(sys.path)},
        timeout=PATIENCE,
        check=True,
    ).stdout
