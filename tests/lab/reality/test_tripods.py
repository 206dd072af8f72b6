"""A triangle on three points: its calibration, and pushes of known loads."""

import numpy as np

from quasistatic_ref.lab.folders import reality_folder
from validation.make.reality_tripods import (
    calibration,
    tripod,
    tripod_prediction,
    tripods_read,
)


def test_three_points_are_predicted_to_a_third_of_their_turn():
    sets = tripods_read(reality_folder())
    frozen = calibration(sets[0])
    assert [len(own.after) for own in sets] == [50] * 5
    off = []
    turned = []
    for own in sets[1:]:
        scene = tripod(own, frozen)
        for k in range(0, 50, 10):
            end, _ = tripod_prediction(scene, frozen, own.before[k], own.path[k], "off")
            off.append(abs(end[2] - own.after[k, 2]))
            turned.append(abs(own.before[k, 2] - own.after[k, 2]))
    assert np.median(off) < np.median(turned) / 3
