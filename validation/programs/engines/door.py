"""How an adapter is called: one JSON object a line in, one a line out. Needs NumPy alone.

An adapter runs in its engine's own environment, where this package is not. It ends in
``answer(name, layers)``: the layers of the reference vectors that it answers, and ``phenomena``,
whose question is a scene and a setting (docs/engines.md) and whose answer is where the bodies are
at the scene's times.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from typing import Any

import numpy as np


class Unsupported(Exception):
    """A case that an engine does not take."""


def _unsupported(_case: Any) -> Any:
    raise Unsupported("this layer is not answered")


def answer(name: str, layers: dict[str, Callable[[Any], Any]]) -> None:
    """Answer every line of standard input.

    Parameters
    ----------
    name : str
        Engine and version.
    layers : dict
        Layer -> function of a case's input that returns the output, or raises `Unsupported`.
    """
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what an engine prints is no answer
    said = {"protocol": 1, "implementation": name, "layers": list(layers)}
    print(json.dumps(said), file=out, flush=True)
    for line in sys.stdin:
        case = json.loads(line)
        try:
            answered = layers.get(case["layer"], _unsupported)
            record = {"output": plain(answered(case["input"]))}
        except Unsupported as reason:
            record = {"error": f"left out: {reason}"}
        except Exception as error:
            record = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps({"id": case["id"], **record}), file=out, flush=True)


def plain(value: Any) -> Any:
    """Arrays as lists."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def rotation(quaternion: Any) -> np.ndarray:
    """Rotation of q/|q|, q = [x, y, z, w]."""
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    V = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * V + 2 * V @ V


def run(scene: Any, h: float, step: Callable[[dict[str, Any]], None], pose: Any) -> Any:
    """Poses at the times of a scene, of an engine that takes steps of h.

    Parameters
    ----------
    scene : dict
    h : float
        [s].
    step : callable
        One step under loads {body: (force, torque)} at the centres of mass, in world axes.
    pose : callable
        Body -> [x, y, z, qx, qy, qz, qw].
    """
    found: dict[str, list[Any]] = {body["name"]: [] for body in scene["bodies"]}
    done = 0
    for time in scene["times"]:
        while done < round(time / h):
            loads = {body["name"]: np.zeros((2, 3)) for body in scene["bodies"]}
            for load in scene["loads"]:
                if done >= round(load["from"] / h):
                    loads[load["body"]] += [load["force"], load["torque"]]
            step(loads)
            done += 1
        for name, poses in found.items():
            poses.append([float(x) for x in pose(name)])
    return {"poses": found}
