"""Engines side by side: the committed page is that of the results, and answers hang on friction."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from validation.make.engines import ENGINES, RESULTS, records
from validation.programs.engines import ask, quasistatic
from validation.programs.engines.phenomena import PHENOMENA, RADIUS, on_turntable
from validation.programs.engines.scenes import simulated
from validation.programs.engines.table import CROSSES, crosses, page, reason

COMMITTED = records(RESULTS / "engines")


def test_the_page_is_that_of_the_results():
    assert (RESULTS / "engines" / "phenomena.md").read_text("utf-8") == page(COMMITTED)


def test_every_cross_has_a_sentence_and_every_sentence_a_cross():
    said = {
        name: {reason(name, *cross) for cross in crosses(COMMITTED[name])} for name in COMMITTED
    }
    written = {name: {entry["why"] for entry in CROSSES.get(name, ())} for name in COMMITTED}
    assert said == written


def test_a_body_on_a_turntable_keeps_its_radius_where_friction_bears_the_drag():
    """A step turns the table and what sticks on it by one screw; drag is m v / h up to mu_v m g."""
    scene = on_turntable()
    setting = quasistatic.SETTINGS["pyramid, steps of 0.1 s"]
    motion = simulated(scene, quasistatic.Engine(scene, setting), setting["h"])
    assert np.abs(np.linalg.norm(motion.places[:, :2], axis=1) - RADIUS).max() < 1e-8
    assert motion.turns.sum() == pytest.approx(2.0)
    slippery = replace(scene, mu_v=0.01)
    motion = simulated(slippery, quasistatic.Engine(slippery, setting), setting["h"])
    assert motion.places[-1, 1] < RADIUS / 10  # hardly carried along


@pytest.mark.extra("compared")
@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("phenomenon", ["incline_angle", "torsional_limit"])
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_wrong_friction_turns_a_cell(name, phenomenon):
    engine = import_module(f"validation.programs.engines.{name}")
    setting = next(iter(engine.SETTINGS.values()))
    question = PHENOMENA[phenomenon]
    if question.torsion and engine.NO_TORSION:
        assert "value" not in ask.cell(engine, setting, question)
        return
    assert question.holds(ask.value(engine, setting, question))
    assert not question.holds(ask.value(engine, setting, question.with_friction(1.2)))
