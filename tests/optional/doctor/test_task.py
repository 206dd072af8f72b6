"""Fillers in the sentence of idle contacts."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import Targets
from quasistatic_ref.simulate.target import JointTrack
from tests.optional.rows import CASES, made


@pytest.mark.parametrize(
    ("at", "words"),
    [(-0.4, "none comes near enough to have a distance"), (-0.1, "is 28.2 mm apart")],
    ids=["beyond the margin", "within it"],
)
def test_a_filler_is_no_distance_of_idle_contacts(at, words):
    (row,) = (row for row in CASES if row["what"].startswith("a scene without targets"))
    moved = row["mjcf"].replace('"-0.4 0 0.05"', f'"{at} 0 0.05"')
    scene = made(row, {"mjcf": moved, "with.margin": 0.1})
    (joint,) = [one for one in scene.system.joints if one.actuated]
    start = scene.system.q_start
    track = JointTrack(joint, np.array([0.0, 0.1]), np.array([[0.0], [0.002]]))
    targets = Targets(start[: scene.system.n_q_a], [track])
    run = qr.rollout(scene.simulator(), start, targets, 10, progress=False)
    (found,) = [one for one in run.findings if one.name == "idle-contacts"]
    assert words in found.cause
    assert "e+0" not in found.sentence
