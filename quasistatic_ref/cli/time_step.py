"""What a scenario says about its time step h: a rule of thumb, before anything runs."""

import math
from typing import Final

import numpy as np

from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.step.arrays import Array, Indices

SLOW: Final = 0.1
"""Largest share of the friction that contacts can bear [-] which the spurious drag may take without
a warning: forces on moving bodies are then wrong by a tenth of that friction."""


def time_step_record(scenario: Scenario) -> dict[str, float | None]:
    """How fast the targets are, and what that asks of h, (R12) and (R13).

    Of links only those with a shape in a contact are looked at, in the two steps next to each
    waypoint.

    Parameters
    ----------
    scenario : Scenario

    Returns
    -------
    dict
        ``target_speed``: of the fastest shape, at its origin [m/s]. ``small_drag_from``: the h
        [s] from which on the drag m v / h of a body that is as fast is below a tenth of mu_v m g,
        with the smallest mu_v > 0. ``target_turn``: the largest turn of a link in a step [rad].
        ``between_waypoints``: the shortest time [s]. None where there is none.
    """
    way, turn = _fastest(scenario)
    speed = way / scenario.h
    smallest = min((pair.mu_v for pair in scenario.pairs if pair.mu_v > 0), default=0.0)
    bears = SLOW * smallest * float(np.linalg.norm(scenario.gravity))
    h = speed / bears if speed > 0 and bears > 0 else math.inf
    tracks = [track.times for track in scenario.targets.tracks if len(track.times) > 1]
    return {
        "target_speed": speed,
        "small_drag_from": h if math.isfinite(h) else None,
        "target_turn": turn,
        "between_waypoints": min((float(np.diff(times).min()) for times in tracks), default=None),
    }


def time_step_words(record: dict[str, float | None]) -> str:
    """What a record says in words; none where no target moves.

    Parameters
    ----------
    record : dict of str to float
        Of :func:`time_step_record` [m/s, s, rad].
    """
    speed = record["target_speed"]
    h = record["small_drag_from"]
    turn = round(record["target_turn"] or 0.0, 4)
    between = record["between_waypoints"]
    words = []
    if speed:
        words.append(f"targets move by up to {speed:.3g} m/s")
    if h:
        words.append(f"drag is below a tenth of friction on a body's weight from h = {h:.3g} s on")
    if turn:
        words.append(f"targets turn by up to {turn:g} rad a step")
    if words and between:
        words.append(f"waypoints are at least {between:.3g} s apart")
    return "; ".join(words)


def _fastest(scenario: Scenario) -> tuple[float, float]:
    """The longest way [m] and the largest turn [rad] that targets take in a step."""
    placed = [shape for pair in scenario.pairs for shape in (pair.alpha, pair.beta)]
    tracks = scenario.targets.tracks
    if not placed or not tracks:
        return 0.0, 0.0
    links = np.array([shape.link for shape in placed])
    origins = np.array([shape.t for shape in placed])
    h = scenario.h
    steps = scenario.steps
    waypoints = np.concatenate([track.times for track in tracks])
    after = np.floor(np.clip(waypoints, 0, steps * h) / h).astype(int)
    way = turn = 0.0
    for k in np.unique(np.clip([after - 1, after], 0, steps - 1)).tolist():
        R, x = _at(scenario, k * h, links, origins)
        R_next, x_next = _at(scenario, (k + 1) * h, links, origins)
        chord = np.linalg.norm(R_next - R, axis=(1, 2))  # sqrt(8) sin(angle / 2)
        angle = 2 * np.arcsin(np.minimum(chord / np.sqrt(8), 1.0))
        way = max(way, float(np.linalg.norm(x_next - x, axis=1).max()))
        turn = max(turn, float(angle.max()))
    return way, turn


def _at(scenario: Scenario, t: float, links: Indices, origins: Array) -> tuple[Array, Array]:
    """Rotations of links, and origins [m] of shapes on them, where targets are reached."""
    system = scenario.system
    kinematics = system.kinematics(system.with_actuated(system.q_start, scenario.targets(t)))
    R = kinematics.R[links]
    return R, kinematics.t[links] + np.einsum("sij,sj->si", R, origins)
