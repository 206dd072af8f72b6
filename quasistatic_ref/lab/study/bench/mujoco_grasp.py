"""MuJoCo stepping a comparable grasp: the same bunny, as its hull, between the same two fingers."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.bench.timing import in_turn, microseconds
from quasistatic_ref.resources import models_folder

MJCF = """<mujoco>
<option timestep="0.01" integrator="implicitfast" cone="pyramidal" gravity="0 0 -9.81"/>
<default><geom condim="4" friction="0.5 0.003 0.0001"/></default>
<asset><mesh name="bunny" file="bunny.obj"/></asset>
<worldbody>
  <geom type="plane" size="1 1 1" friction="0.5 0.003 0.0001"/>
  <body name="palm" pos="0.02 -0.011 0.175">
    <joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/>
    <joint name="z" type="slide" axis="0 0 1"/>
    <joint name="rx" axis="1 0 0"/><joint name="ry" axis="0 1 0"/><joint name="rz" axis="0 0 1"/>
    <inertial pos="0 0 0" mass="0.6" diaginertia="1.2e-3 4e-4 1.2e-3"/>
    <body name="left" pos="0 0.0415 -0.075"><joint name="left" type="slide" axis="0 1 0"/>
      <geom type="box" size="0.012 0.006 0.06" mass="0.1" friction="0.6 0.003 0.0001"/></body>
    <body name="right" pos="0 -0.0415 -0.075"><joint name="right" type="slide" axis="0 -1 0"/>
      <geom type="box" size="0.012 0.006 0.06" mass="0.1" friction="0.6 0.003 0.0001"/></body>
  </body>
  <body name="bunny"><freejoint/><geom type="mesh" mesh="bunny" mass="0.2"/></body>
</worldbody>
<equality><joint joint1="left" joint2="right"/></equality>
<actuator>
  <position joint="x" kp="2000" kv="60"/><position joint="y" kp="2000" kv="60"/>
  <position joint="z" kp="2000" kv="60"/><position joint="rx" kp="50" kv="2"/>
  <position joint="ry" kp="50" kv="2"/><position joint="rz" kp="50" kv="2"/>
  <position joint="left" kp="1000" kv="30"/>
</actuator></mujoco>"""

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
    model = mujoco.MjModel.from_xml_string(MJCF, {"bunny.obj": mesh.read_bytes()})
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
