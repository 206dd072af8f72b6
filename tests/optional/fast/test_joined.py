"""Steps of many bodies are kept by contact and by body."""

import numpy as np
import pytest

from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.model import system as system_module
from quasistatic_ref.optional.fast import joined
from quasistatic_ref.optional.fast import simulator as of_fast
from quasistatic_ref.simulate.rollout import rollout


@pytest.mark.extra("fast")
def test_runs_and_findings_of_many_bodies_form_no_whole_arrays(monkeypatch):
    """J has 4 n_c n_v entries, and M_u n_u^2: of 1000 boxes that is 0.8 and 0.3 GB."""
    monkeypatch.setattr(of_fast, "MOST", 1)  # of larger steps units are not compared
    scene = boxes(50)
    n_v = len(scene.force)
    wholes = []
    for module, name in ((joined, "spread"), (joined, "whole"), (system_module, "whole")):
        form = getattr(module, name)

        def noted(*arguments, form=form):
            array = form(*arguments)
            wholes.extend([array.shape] if array.shape[-1] == n_v else [])
            return array

        monkeypatch.setattr(module, name, noted)
    simulator = scene.simulator("off", True)
    options = {"force": scene.force, "record": "light", "progress": False, "findings": False}
    run = rollout(simulator, scene.q, np.zeros(0), 2, **options)
    assert {finding.name for finding in run.findings} >= {"equilibrium"}
    assert simulator.by_c
    assert not wholes
    monkeypatch.undo()
