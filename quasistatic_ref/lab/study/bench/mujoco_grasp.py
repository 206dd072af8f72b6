"""MuJoCo stepping a comparable grasp: the same bunny, as its hull, between the same two fingers."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.resources import models_folder
from quasistatic_ref.lab.study.bench.timing import in_turn, microseconds

SETTLE = 200
"""Steps until the fingers press on the bunny."""


def mujoco_grasp(steps: int, repeat: int) -> dict[str, Any]:
    """Median time of a step of MuJoCo with its contacts, or why there is none.

    Its step is a dynamic one, of the same size but of another model: bodies have velocities, and
    contacts are soft. It finds its contacts on the bunny's convex hull.

    Raises
    ------
    InputError
        If the bunny's mesh is missing.
    """
    try:
        mujoco: Any = import_module("mujoco")
    except ImportError:
        return {"not run": "MuJoCo is not installed; pip install 'quasistatic-ref[engines]'"}
    mesh = models_folder() / "bunny_grasp" / "bunny.obj"
    if not mesh.is_file():
        raise InputError("is missing", file=mesh)
    scene = Path(__file__).with_suffix(".xml").read_text(encoding="utf-8")
    model = mujoco.MjModel.from_xml_string(scene, {"bunny.obj": mesh.read_bytes()})
    data = mujoco.MjData(model)
    data.ctrl[6] = -0.006  # the fingers close
    for _ in range(SETTLE):
        mujoco.mj_step(model, data)
    rows = [{"MuJoCo": lambda: mujoco.mj_step(model, data)} for _ in range(steps)]
    times = in_turn(rows, repeat)["MuJoCo"]
    return {
        "microseconds": microseconds(times),
        "contacts": int(data.ncon),
        "rows": int(data.nefc),
        "coordinates": int(model.nv),
        "finite": bool(np.isfinite(data.qpos).all()),
    }
