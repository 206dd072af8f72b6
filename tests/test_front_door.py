"""The front door: every name is there in every order of imports, documented, with an example."""

import doctest
import subprocess
import sys
import tempfile
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.extras import marked_parameters

PACKAGE = Path(qr.__file__).parent
NAMES = [name for name in qr.__all__ if name != "__version__"]
JAX = "smoothed_jax", "step_jax"
"""What takes steps in JAX, their examples too."""
VIEW = {"view_written": "view"}
ASKED = (
    "System Body Sphere Box Capsule Cylinder HalfSpace PointCloud ContactPair PlacedShape "
    "Simulator rollout solve_step verify standard_form StepProblem StepData Contacts Extra "
    "Extension derivatives load_scenario Trajectory Recorder "
    "QuasistaticError InputError StepNotSolved RunFailed"
)
"""What a scene in Python needs, from building it to catching what goes wrong."""
BEFORE_OR_AFTER = """
import sys, importlib
import cvxpy, pinocchio, coal  # once: what is imported again below is the package alone

for folder in ("simulate", "solve", "cli.main"):  # each before and after the names
    for first, then in ((folder, None), (None, folder)):
        for module in [m for m in sys.modules if m.partition(".")[0] == "quasistatic_ref"]:
            del sys.modules[module]
        qr = importlib.import_module("quasistatic_ref")
        if first: importlib.import_module(f"quasistatic_ref.{first}")
        names = [name for name in qr.__all__ if name != "__version__"]
        values = {name: getattr(qr, name) for name in names}
        if then: importlib.import_module(f"quasistatic_ref.{then}")
        for name, value in values.items():
            home = importlib.import_module(f"quasistatic_ref.{qr._HOME[name]}")
            assert value is getattr(home, name) is getattr(qr, name), (name, folder)
print("good")
"""


def run(*arguments):
    command = [sys.executable, *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=120, cwd=PACKAGE.parent, check=False
    )


def test_the_names_are_those_that_dir_shows():
    assert dir(qr) == sorted(qr.__all__)
    assert set(ASKED.split()) <= set(dir(qr))
    assert len(set(NAMES)) == len(NAMES)


@pytest.mark.parametrize("name", marked_parameters(NAMES, dict.fromkeys(JAX, "jax") | VIEW))
def test_every_name_says_what_it_is_with_an_example_that_runs(name, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # some examples write a file
    said = getattr(qr, name).__doc__
    example = doctest.DocTestParser().get_doctest(said, {"qr": qr, "np": np}, name, None, None)
    assert example.examples
    assert doctest.DocTestRunner().run(example).failed == 0


@pytest.mark.parametrize("name", JAX)
def test_without_jax_one_sentence_names_the_extra(name, monkeypatch):
    simulator = qr.load_scenario("block_push").simulator()
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(qr.InputError, match=r"pip install 'quasistatic-ref\[jax\]'"):
        getattr(qr, name)(simulator)


def test_no_name_is_that_of_a_module_which_python_would_put_in_its_place():
    modules = {path.stem for path in PACKAGE.iterdir()}
    assert {"simulate", "step", "errors"} <= modules
    assert not modules & set(NAMES)


@pytest.mark.long
def test_every_name_is_reliable_in_every_order_of_imports():
    done = run("-W", "error", "-c", BEFORE_OR_AFTER)
    assert (done.returncode, done.stdout.strip()) == (0, "good"), done.stderr


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'simulat'"):
        attrgetter("simulat")(qr)


def test_python_m_is_the_command_line():
    done = run("-m", "quasistatic_ref", "--version")
    assert (done.returncode, done.stdout.strip()) == (0, qr.__version__), done.stderr
    bad = run("-m", "quasistatic_ref", "run", "no_such_scenario")
    assert bad.returncode == 2
    assert "no_such_scenario" in bad.stderr
