"""Random valid steps at scales of 1e-12 to 1e12: no backend holds one up.

``python -m validation.tools.fuzz --readers validation.make.hostile_steps`` has each backend by each
interface solve them, certified in full, in processes with limits. A step ends exact, with the bits
that it has without a backend, or refused in a sentence.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.solve.backends import NONE, QPSOLVERS, installed, installed_backends
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.files import step_read, step_text
from tests.oracles.attacked_steps import hostile_step
from validation.tools.fuzzing.worker import Reader

PAGE = """# Steps at all scales, and what holds them up

Written by `python -m validation.tools.fuzz --readers validation.make.hostile_steps`. The numbers of
random steps of up to 12 coordinates and 8 contacts are multiplied by powers of ten from 1e-12 to
1e12, one for all or one for each coordinate, contact or kind of number; all are valid steps, many
of which no mechanism has. Each is solved with `certify = "full"` by each backend through each
interface, the same steps by all. `accepted`: the exact optimum, with the bits that it has without a
backend. `refused`: in one sentence; most have no solution, which is proved. `failures`: other bits,
a traceback or a warning, the end of the process, or more than 10 s of processor time, which would
include the exact method's own and that of the comparison.

"""


def hostile_text(rng: random.Random, good: bytes) -> bytes:
    """A step that can be read, as a file."""
    while True:
        try:
            return step_text(hostile_step(rng)).encode()
        except InputError:
            continue


def paths() -> list[tuple[str, str]]:
    """Every backend that is here by every interface: (engine, name)."""
    through = [("cvxpy", name) for name in (NONE, *installed_backends())]
    return through + [("native", name) for name in installed("native")]


def readers(folder: Path) -> dict[str, Reader]:
    """One for each path; see :mod:`validation.tools.fuzz`."""
    good = step_text(grasp_step(np.random.default_rng(0))).encode()
    return {
        label(engine, name): Reader("step.json", (good,), hostile_text, solved_by(engine, name))
        for engine, name in paths()
    }


def label(engine: str, name: str) -> str:
    """E.g. ``native daqp``, ``qpsolvers daqp``."""
    return f"{engine} {name}" if not name.startswith(QPSOLVERS) else name.replace(":", " ")


def solved_by(engine: str, name: str) -> Callable[[Path], str]:
    """What solves a file: it returns the bits of the answer, and what became of the backend."""

    def read(path: Path) -> str:
        step = step_read(path)
        solution = solve_step(step, solver_for(step, name, fast=engine == "native"))
        if name != NONE:
            assert solution.delta_q.tobytes() == solve_step(step, NONE).delta_q.tobytes()
        return str(solution.statistics.status)

    return read


def names() -> list[str]:
    """Every reader."""
    return [label(*path) for path in paths()]
