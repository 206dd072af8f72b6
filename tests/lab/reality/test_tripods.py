"""A triangle on three points: its calibration, and pushes of known loads."""

import numpy as np
import pytest

from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.outline import rotation
from quasistatic_ref.lab.reality.pushes import Pushes
from validation.make.reality_tripods import (
    TRIANGLE,
    TripodSet,
    calibration,
    tripod,
    tripod_prediction,
    tripods_read,
)

OFFSET = np.array([6e-4, -4e-4])
ANGLE = 0.004
RADIUS = 0.003


def planted():
    """Pushes that end where a finger of that radius touches the outline in the offset frame."""
    rng = np.random.default_rng(0)
    after = rng.uniform(-1, 1, size=(30, 3))
    vertices = TRIANGLE.vertices
    edges = TRIANGLE.edges
    path = np.zeros((30, 40, 2))
    for k, pose in enumerate(after):
        edge = edges[k % 3] / np.linalg.norm(edges[k % 3])
        outward = np.array([edge[1], -edge[0]])
        own = vertices[k % 3] + rng.uniform(0.2, 0.8) * edges[k % 3] + RADIUS * outward
        origin = pose[:2] + rotation(pose[2]) @ OFFSET
        path[k] = origin + rotation(pose[2] + ANGLE) @ own
    pushes = Pushes(np.arange(30), after, after, path, None)
    return TripodSet("planted", np.zeros((3, 2)), pushes)


def test_the_calibration_finds_planted_offsets_and_radius():
    found = calibration(planted())
    assert found.offset == pytest.approx(OFFSET, abs=1e-7)
    assert found.angle == pytest.approx(ANGLE, abs=1e-5)
    assert found.radius == pytest.approx(RADIUS, abs=1e-7)


def test_three_points_are_predicted_to_a_third_of_their_turn():
    sets = tripods_read(reality_folder())
    frozen = calibration(sets[0])
    assert [len(own.pushes.after) for own in sets] == [50] * 5
    off = []
    turned = []
    for own in sets[1:]:
        scene = tripod(own, frozen)
        some = own.pushes.every(10)
        for before, path, after in zip(some.before, some.path, some.after, strict=True):
            end, _ = tripod_prediction(scene, frozen, before, path, "off")
            off.append(abs(end[2] - after[2]))
            turned.append(abs(before[2] - after[2]))
    assert np.median(off) < np.median(turned) / 3
