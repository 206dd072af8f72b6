"""Runs of the study of second-order simulators, and what each is worth.

``second_order.toml`` has scenes, grid and thresholds. A run is a scene at a speed, taken by an
engine at a setting with steps of h; its answer has the poses of the bodies at the scene's times.
What is measured is computed from these poses alone, and the same for every engine.
"""

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

STUDY = tomllib.loads((Path(__file__).parent / "second_order.toml").read_text())
GRAVITY = 9.81
EVERY = 0.1
"""Times are multiples of it, as they are of every h [s]."""


class Run(NamedTuple):
    """One run of the study.

    Parameters
    ----------
    scene : str
    speed : float
        [m/s].
    engine, setting : str
    h : float
        [s].
    """

    scene: str
    speed: float
    engine: str
    setting: str
    h: float


def runs() -> list[Run]:
    """The grid, after what scenes without a closed form are compared with."""
    reference = STUDY["reference"]
    engines = (reference["engine"], reference["setting"]), reference["second"]
    return [
        Run(scene, speed, *engine, reference["h"])
        for scene in STUDY["scene"]
        if not closed_form(scene)
        for speed in STUDY["speeds"]
        for engine in engines
    ] + [
        Run(scene, speed, engine, setting, h)
        for scene in STUDY["scene"]
        for speed in STUDY["speeds"]
        for engine, settings in STUDY["engines"].items()
        for setting in settings
        for h in STUDY["steps"]
        if h >= settings[setting].get("least_h", 0.0)
    ]


def closed_form(scene: str) -> bool:
    """Whether a scene's motion has a closed form."""
    return "like" not in STUDY["scene"][scene]


def scene_of(name: str, speed: float) -> dict[str, Any]:
    """A scene whole, as adapters are asked for it: with targets of the servos, and times."""
    own = STUDY["scene"][name]
    scene = {**STUDY["scene"][own["like"]], **own} if "like" in own else dict(own)
    shift = own.get("shift", {})
    scene["bodies"] = [
        {**body, "xyz": list(np.add(body["xyz"], shift.get(body["name"], 0.0)))}
        for body in scene["bodies"]
    ]
    start, *held = scene["before"][-1]
    way = min(STUDY["way"], STUDY["longest"] * speed)
    end = start + way / speed
    there = np.array(held) + way * np.eye(3)[scene["along"]]
    corners = np.array([*scene["before"], [end, *there], [end + STUDY["rest"], *there]])
    scene["targets"] = {
        mover: (corners * [1, -1, 1, 1] if mover in scene.get("mirrored", ()) else corners).tolist()
        for mover in scene["mover"]
    }
    steps = max(1, round((end - start) / EVERY / STUDY["samples"]))
    moving = np.arange(round(start / EVERY), round(end / EVERY), steps)
    last = np.arange(round(end / EVERY), round((end + STUDY["rest"]) / EVERY) + 1)
    scene["times"] = [round(EVERY * k, 9) for k in [*moving, *last]]
    scene["loads"] = []
    return scene


def target_displacement(scene: dict[str, Any]) -> np.ndarray:
    """Displacement of the first mover's target along the way, at the scene's times [m]."""
    times, *places = np.array(scene["targets"][scene["mover"][0]]).T
    return np.interp(scene["times"], times, places[scene["along"]])


def quasistatic(name: str, scene: dict[str, Any]) -> np.ndarray:
    """Displacement of the body along the way by Coulomb's law without inertia [m].

    - Lift: fingers that hold the bar rise with it, each under half of its weight: K dz = m g / 2.
    - Push: the block slides under mu m g, which the spring of the finger bears, 1 mm from touching.
    """
    body, finger = scene["bodies"][:2]
    weight = body["mass"] * GRAVITY
    if name == "lift":
        return np.maximum(0.0, target_displacement(scene) - weight / 2 / finger["K"])
    apart = body["xyz"][0] - finger["xyz"][0] - body["shapes"][0]["size"][0] / 2
    apart -= finger["shapes"][0]["radius"]
    return np.maximum(
        0.0, target_displacement(scene) - apart - scene["mu_v"] * weight / finger["K"]
    )


class Motion(NamedTuple):
    """Of the body at the scene's times.

    Parameters
    ----------
    places : ndarray, shape (N, 3)
        From where it starts [m].
    turns : Rotation
        From how it starts; N of them.
    """

    places: np.ndarray
    turns: Rotation


def motion(scene: dict[str, Any], poses: dict[str, Any]) -> Motion:
    """The motion of a scene's body."""
    body = scene["bodies"][0]
    table = np.array(poses[body["name"]], dtype=float)
    if not np.isfinite(table).all():
        raise ValueError("poses are no numbers")
    return Motion(table[:, :3] - body["xyz"], Rotation.from_quat(table[:, 3:]))


def expected_motion(name: str, scene: dict[str, Any]) -> Motion:
    """The closed form: the body moves along the way and does not turn."""
    places = np.outer(quasistatic(name, scene), np.eye(3)[scene["along"]])
    return Motion(places, Rotation.from_quat(np.tile([0.0, 0.0, 0.0, 1.0], (len(places), 1))))


def measures(
    scene: dict[str, Any], poses: dict[str, Any], reference: Motion
) -> dict[str, float | bool]:
    """What a run is worth, by the thresholds of the study.

    Returns
    -------
    dict
        way, turn: largest error of the pose from the start of the way to the end of the rest [m,
        deg]. end_way, end_turn: at the end. depth: largest penetration [m]. creep: mean speed in
        the second half of the rest [m/s]. holds, right: by ``thresholds``.
    """
    limits = STUDY["thresholds"]
    found = motion(scene, poses)
    ways = np.linalg.norm(found.places - reference.places, axis=1)
    turns = np.degrees((reference.turns.inv() * found.turns).magnitude())
    half = np.searchsorted(scene["times"], scene["times"][-1] - STUDY["rest"] / 2)
    crept = np.linalg.norm(found.places[-1] - found.places[half])
    row = {
        "way": ways.max(),
        "turn": turns.max(),
        "end_way": ways[-1],
        "end_turn": turns[-1],
        "depth": depth(scene, poses),
        "creep": crept / (scene["times"][-1] - scene["times"][half]),
    }
    holds = row["end_way"] <= limits["holds"]["way"] and row["end_turn"] <= limits["holds"]["turn"]
    close = row["way"] <= limits["pose"]["way"] and row["turn"] <= limits["pose"]["turn"]
    still = row["depth"] <= limits["depth"] and row["creep"] <= limits["creep"]
    numbers = {key: float(f"{value:.4g}") for key, value in row.items()}
    return numbers | {"holds": bool(holds), "right": bool(holds and close and still)}


def depth(scene: dict[str, Any], poses: dict[str, Any]) -> float:
    """Largest penetration of balls into the floor and into the faces of the body's box [m]."""
    body, *fingers = scene["bodies"]
    at = np.array(poses[body["name"]], dtype=float)
    turn = Rotation.from_quat(at[:, 3:])
    box, *feet = body["shapes"]
    into = [foot["radius"] - (at[:, :3] + turn.apply(foot["xyz"]))[:, 2] for foot in feet]
    for finger in fingers:
        place = np.array(poses[finger["name"]], dtype=float)[:, :3]
        for ball in finger["shapes"]:
            local = abs(turn.inv().apply(place + ball["xyz"] - at[:, :3]))
            outside = local - np.array(box["size"]) / 2
            gap = np.linalg.norm(np.maximum(outside, 0), axis=1) + np.minimum(outside.max(1), 0)
            into.append(ball["radius"] - gap)
    return float(max(0.0, np.max(into)))
