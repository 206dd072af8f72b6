"""What a scenario says about its time step h: a rule of thumb, before anything runs."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.start import slices
from quasistatic_ref.optional.doctor.tolerances import BEYOND
from quasistatic_ref.scenario.scenario import Scenario

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
        with the smallest mu_v > 0. ``small_layer_to``: the h [s] up to which the layer mu_v h v
        under what slides is below a tenth of the depth to which targets press it. ``target_turn``:
        the largest turn of a link in a step [rad]. ``between_waypoints``: the shortest time [s].
        None where there is none.
    """
    way, turn = _fastest(scenario)
    speed = way / scenario.h
    smallest = min((pair.mu_v for pair in scenario.pairs if pair.mu_v > 0), default=0.0)
    bears = SLOW * smallest * float(np.linalg.norm(scenario.gravity))
    moved = scenario.system.n_v > scenario.system.n_a  # what is actuated feels no drag
    h = speed / bears if moved and speed > 0 and bears > 0 else math.inf
    tracks = [track.times for track in scenario.targets.tracks if len(track.times) > 1]
    return {
        "target_speed": speed,
        "small_drag_from": h if math.isfinite(h) else None,
        "small_layer_to": _thinnest_layer(scenario),
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
    if layer := record["small_layer_to"]:
        words.append(
            "where what targets press slides, its layer is below a tenth of their depth up to "
            f"h = {layer:.3g} s"
        )
    if turn:
        words.append(f"targets turn by up to {turn:g} rad a step")
    if words and between:
        words.append(f"waypoints are at least {between:.3g} s apart")
    return "; ".join(words)


def _fastest(scenario: Scenario) -> tuple[float, float]:
    """The longest way [m] and the largest turn [rad] that targets take in a step."""
    sides = [side for pair in scenario.pairs for side in (pair.alpha, pair.beta)]
    way = turn = 0.0
    for before, after in _steps(scenario):
        for side in sides:
            link = side.link
            origin = after.R[link] @ side.t + after.t[link]
            way = max(way, float(np.linalg.norm(_moved(before, after, link, origin))))
            chord = float(np.linalg.norm(after.R[link] - before.R[link]))  # sqrt(8) sin(angle / 2)
            turn = max(turn, 2 * math.asin(min(chord / math.sqrt(8), 1.0)))
    return way, turn


def _thinnest_layer(scenario: Scenario) -> float | None:
    """The least h [s] for which mu_v h v is a tenth of the depth of a pair that slides.

    Free bodies stand where they start: of their pairs, which they follow from then on, the first
    step counts in which they press and slide.
    """
    simulator = scenario.simulator()
    column_map = scenario.system.column_map
    free = np.any(column_map.moves[:, :, column_map.owner >= scenario.system.n_a], axis=(1, 2))
    bounds: dict[str, list[float]] = {}
    for before, after in _steps(scenario):
        try:
            points = simulator.closest_points(after)
        except ContactError:  # a pose that no step has
            continue
        for pair, at in slices(scenario.pairs):
            j = at.start + int(points.phi[at].argmin())
            depth = -float(points.phi[j])
            links = [pair.alpha.link, pair.beta.link]
            moved = [_moved(before, after, link, points.beta[j]) for link in links]
            slip = moved[1] - moved[0]
            along = slip - (slip @ points.n[j]) * points.n[j]
            way = float(np.linalg.norm(along))
            followed = free[links].any() and pair.name in bounds
            if min(depth, way) > BEYOND and pair.mu_v > 0 and not followed:
                h = SLOW * depth / (pair.mu_v * way / scenario.h)
                bounds.setdefault(pair.name, []).append(h)
    return min((h for each in bounds.values() for h in each), default=None)


def _steps(scenario: Scenario) -> Iterator[tuple[Kinematics, Kinematics]]:
    """Where links are before and after the steps next to a waypoint, targets being reached."""
    tracks = scenario.targets.tracks
    if not tracks:
        return
    h = scenario.h
    steps = scenario.steps
    waypoints = np.concatenate([track.times for track in tracks])
    at = np.floor(np.clip(waypoints, 0, steps * h) / h).astype(int)
    for k in np.unique(np.clip([at - 1, at], 0, steps - 1)).tolist():
        yield _at(scenario, k * h), _at(scenario, (k + 1) * h)


def _at(scenario: Scenario, t: float) -> Kinematics:
    system = scenario.system
    return system.kinematics(system.with_actuated(system.q_start, scenario.targets(t)))


def _moved(before: Kinematics, after: Kinematics, link: int, x: Array) -> Array:
    """How far the point of a link that is at x after a step moves in it, shape (3,) [m]."""
    in_link = (x - after.t[link]) @ after.R[link]
    return np.asarray(x - before.R[link] @ in_link - before.t[link])
