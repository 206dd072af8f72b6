"""How an adapter is called: one JSON object a line in, one a line out. Needs NumPy alone.

An adapter runs in its engine's own environment, where this package is not. It ends in
``answer(name, phenomena)``: the question is a scene and a setting (docs/engines.md), and the answer
is where the bodies are at the scene's times.
"""

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np


class Unsupported(Exception):
    """A case that an engine does not take."""


def answer(name: str, phenomena: Callable[..., Any]) -> None:
    """Answer every line of standard input.

    Parameters
    ----------
    name : str
        Engine and version.
    phenomena : callable
        Of ``scene`` and ``setting``: what `run` returns; or it raises `Unsupported`.
    """
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what an engine prints is no answer
    said = {"protocol": 1, "implementation": name, "layers": ["phenomena"]}
    print(json.dumps(said), file=out, flush=True)
    for line in sys.stdin:
        case = json.loads(line)
        try:
            record = {"output": phenomena(**case["input"])}
        except Unsupported as reason:
            record = {"error": f"left out: {reason}"}
        except Exception as error:
            record = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps({"id": case["id"], **record}), file=out, flush=True)


def aims(scene: Any, t: float) -> dict[str, Any]:
    """Targets of a scene's servos at a time: body -> (displacement [m], velocity [m/s])."""
    found = {}
    for name, corners in scene.get("targets", {}).items():
        times, *places = np.array(corners).T
        k = min(max(int(np.searchsorted(times, t - 1e-9)), 1), len(times) - 1)
        slope = [(at[k] - at[k - 1]) / (times[k] - times[k - 1]) for at in places]
        velocity = np.array(slope) if t < times[-1] + 1e-9 else np.zeros(3)
        found[name] = np.array([np.interp(t, times, at) for at in places]), velocity
    return found


def run(
    scene: Any,
    h: float,
    step: Callable[[dict[str, Any]], None],
    pose: Any,
    aim: Callable[[float], None] | None = None,
) -> Any:
    """Poses at the times of a scene, of an engine that takes steps of h, and its processor time.

    Parameters
    ----------
    scene : dict
    h : float
        [s].
    step : callable
        One step under loads {body: (force, torque)} at the centres of mass, in world axes.
    pose : callable
        Body -> [x, y, z, qx, qy, qz, qw].
    aim : callable, optional
        Sets the targets of servos for the step that begins at a time [s].
    """
    found = {body["name"]: [] for body in scene["bodies"]}
    done = 0
    seconds = 0.0
    for instant in scene["times"]:
        while done < round(instant / h):
            loads = {body["name"]: np.zeros((2, 3)) for body in scene["bodies"]}
            for load in scene["loads"]:
                if done >= round(load["from"] / h):
                    loads[load["body"]] += [load["force"], load["torque"]]
            if aim:
                aim(done * h)
            start = time.process_time()
            step(loads)
            seconds += time.process_time() - start
            done += 1
        for name, poses in found.items():
            poses.append([float(x) for x in pose(name)])
    return {"poses": found, "seconds": seconds}
