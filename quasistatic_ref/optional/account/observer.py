"""The observer that notes a run's scene in the header of its trajectory."""

from dataclasses import replace

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.observer import NOTING, Observer
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.trajectory import Trajectory


class Noting(Observer):
    """What an account needs of a scene, as the header's field ``scene``.

    It holds ``pairs`` (of each its name, what alpha is and what beta is: a link, or a shape of the
    world), ``waypoints`` (times [s] by joint), ``stiffness`` (the diagonal of K_q, empty where K_q
    has other entries) and ``gravity`` [m/s^2].
    """

    def end(self, recorder: Recorder, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with its scene."""
        K_q = recorder.simulator.K_q
        diagonal = np.diag(K_q)
        scene = {
            "pairs": [sides(recorder.system, pair) for pair in recorder.simulator.pairs],
            "waypoints": {track.joint.name: track.times.tolist() for track in recorder.tracks},
            "stiffness": diagonal.tolist() if np.array_equal(K_q, np.diag(diagonal)) else [],
            "gravity": recorder.simulator.gravity.tolist(),
        }
        return replace(trajectory, header={**trajectory.header, "scene": scene})


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


NOTING.fill(Noting)
