"""The rows of cases/*.toml, and their scenes."""

import copy
import tomllib
from pathlib import Path

import mujoco

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cylinder,
    Sphere,
    load_scenario,
    mujoco_scenario,
)

HERE = Path(__file__).with_name("cases")
ROWS = [
    case
    for file in sorted(HERE.glob("*.toml"))
    for case in tomllib.loads(file.read_text("utf-8"))["case"]
]
UNPROVED = {"certify": "off"}
"""Findings are the same without proofs, which take most of a run's time."""
SOLIDS = {"box": lambda *size: Box(size=size), "sphere": Sphere, "cylinder": Cylinder}
SOLIDS["capsule"] = Capsule


def made(case, changes=(), **more):
    """The scenario of a case, whose simple bodies are made here, or of a scene of MuJoCo."""
    tables = {"fast": True, "solver": UNPROVED} | copy.deepcopy(case.get("scene", case)) | more
    for key, value in dict(changes).items():
        *path, last = key.split(".")
        inner = tables
        for part in path:
            inner = inner[part]
        inner[last] = value
    if "mjcf" in tables:
        model = mujoco.MjModel.from_xml_string(tables["mjcf"])
        return mujoco_scenario(model, **{"h": 0.01, "steps": 1} | tables.get("with", {}))
    for body in tables["bodies"].values():
        kind, *sizes = body["urdf"].split()
        if sizes:
            *sizes, mass = map(float, sizes)
            body["urdf"] = Body.of_shape("solid", SOLIDS[kind](*sizes), mass).urdf
    return load_scenario(tables)
