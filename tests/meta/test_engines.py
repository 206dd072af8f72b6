"""Engines side by side: the committed page is that of the results, and answers hang on friction."""

import subprocess
import sys
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from validation.make.engines import ENGINES, RESULTS, ROOT, records, unanswered
from validation.programs.engines import ask
from validation.programs.engines.phenomena import BALL, PHENOMENA
from validation.programs.engines.scenes import Scene, Shape, simulated, times
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


def test_a_state_that_is_no_number_is_named():
    class Broken:
        def step(self, wrenches):
            pass

        def pose(self, name):
            return [np.nan] * 7

        def normal_forces(self):
            return []

    scene = Scene((BALL,), 0.5, 0.01, times(0.25, 0.5, 0.25))
    with pytest.raises(ValueError, match=r"^the state at 0\.25 s is no number$"):
        simulated(scene, Broken())
    module = SimpleNamespace(NO_TORSION="", Engine=lambda scene, setting: Broken())
    cell = {"setting": "s", "phenomenon": "p"}
    cell |= ask.cell(module, {}, PHENOMENA["sticks_on_slope"])
    (sentence,) = unanswered("broken", {"cells": [cell]})
    assert sentence == "broken, s, p: ValueError: the state at 0.5 s is no number"


def test_a_shape_that_no_engine_knows_is_refused():
    with pytest.raises(ValueError, match=r"'cone'; use sphere or box"):
        Shape("cone", (0.1, 0.2))


def test_a_missing_engine_is_status_2():
    command = [sys.executable, "-m", "validation.programs.engines.ask", "no_such_engine"]
    process = subprocess.run(command, cwd=ROOT, text=True, capture_output=True, check=False)
    assert process.returncode == 2
    assert "no_such_engine" in process.stdout
