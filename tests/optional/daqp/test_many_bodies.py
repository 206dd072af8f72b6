"""Steps of many bodies keep what they have by body and by contact."""

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.lab.bench.scenes import boxes
from tests.wholes import wholes_formed


def test_runs_of_many_bodies_form_no_whole_arrays(monkeypatch):
    """J has 4 n_c n_v entries, and M_u n_u^2: of 1000 boxes that is 0.8 and 0.3 GB."""
    scene = boxes(50)
    wholes = wholes_formed(len(scene.force), monkeypatch)
    plain = scene.simulator("full", False)
    for more in ({"backend": "daqp", "certify": "off"}, {"backend": "daqp"}, {"backend": "none"}):
        simulator = qr.Simulator(plain.system, plain.pairs, h=plain.h, **more)
        options = {"force": scene.force, "record": "light", "progress": False, "findings": False}
        qr.rollout(simulator, scene.q, np.zeros(0), 2, **options)
    assert not wholes
    monkeypatch.undo()
