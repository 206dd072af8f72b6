"""What an account needs of a scene, as the field ``scene`` of a trajectory's header."""

from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.recorder import Recorder


def scene_notes(recorder: Recorder) -> dict[str, Any]:
    """Names and constants that the arrays of a trajectory do not hold.

    Returns
    -------
    dict
        ``pairs`` (of each its name, what alpha is and what beta is: a link, or a shape of the
        world), ``waypoints`` (times [s] by joint), ``stiffness`` (the diagonal of K_q, empty where
        K_q has other entries) and ``gravity`` [m/s^2].
    """
    K_q = recorder.simulator.K_q
    diagonal = np.diag(K_q)
    return {
        "pairs": [sides(recorder.system, pair) for pair in recorder.simulator.pairs],
        "waypoints": {track.joint.name: track.times.tolist() for track in recorder.tracks},
        "stiffness": diagonal.tolist() if np.array_equal(K_q, np.diag(diagonal)) else [],
        "gravity": recorder.simulator.gravity.tolist(),
    }


def sides(system: System, pair: ContactPair) -> list[str]:
    """A pair's name, and the names of what touches."""
    return [pair.name, side(system, pair.alpha), side(system, pair.beta)]


def side(system: System, placed: PlacedShape) -> str:
    """The link that a shape is fixed to, its body's name if they share it; or the world's shape."""
    link = system.links[placed.link]
    body, _, own = link.partition("/")
    if not placed.link:
        return placed.name
    return body if own == body else link
