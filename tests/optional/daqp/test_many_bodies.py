"""Steps of many bodies keep what they have by body and by contact."""

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.model import system as system_module
from quasistatic_ref.step import contacts
from quasistatic_ref.step import hessian as hessian_module


def test_runs_of_many_bodies_form_no_whole_arrays(monkeypatch):
    """J has 4 n_c n_v entries, and M_u n_u^2: of 1000 boxes that is 0.8 and 0.3 GB."""
    scene = boxes(50)
    n_v = len(scene.force)
    wholes = []
    places = ((contacts, "spread"), (hessian_module, "whole"), (system_module, "whole"))
    for module, name in places:
        formed = getattr(module, name)

        def noted(*arguments, formed=formed):
            array = formed(*arguments)
            wholes.extend([array.shape] if array.shape[-1] == n_v else [])
            return array

        monkeypatch.setattr(module, name, noted)
    plain = scene.simulator("full", False)
    for more in ({"backend": "daqp", "certify": "off"}, {"backend": "daqp"}, {"backend": "none"}):
        simulator = qr.Simulator(plain.system, plain.pairs, h=plain.h, **more)
        options = {"force": scene.force, "record": "light", "progress": False, "findings": False}
        qr.rollout(simulator, scene.q, np.zeros(0), 2, **options)
    assert not wholes
    monkeypatch.undo()
