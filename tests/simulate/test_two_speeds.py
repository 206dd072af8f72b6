"""Clarabel and DAQP, kept between steps, take the same steps; the default uses nothing of it."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import load_scenario
from tests.extras import SCENARIOS_TO_RUN
from tests.helpers import first_step
from tests.processes import python
from tests.scenes import BALL

STEPS = {"bunny_grasp": 60}  # its gripper has closed after 50; of the others 6 are taken
SAME = ("q", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "H", "g", "A", "b")


@pytest.mark.parametrize("name", SCENARIOS_TO_RUN)
def test_certified_runs_have_the_same_bits_at_both_speeds(name):
    steps = STEPS.get(name, 6)
    plain, fast = (load_scenario(name, steps=steps, fast=speed).run() for speed in (False, True))
    assert (plain.header.backend, fast.header.backend) == ("clarabel", "daqp")
    assert {*plain["certificate"], *fast["certificate"]} == {"exact"}
    for key in SAME:
        assert plain[key].tobytes() == fast[key].tobytes(), key


@pytest.mark.parametrize("certify", ["full", "residual", "off"])
@pytest.mark.parametrize("backend", ["daqp", "clarabel", "none"])
def test_a_place_that_is_no_number_is_refused_of_a_body_without_contacts_too(backend, certify):
    certify = "full" if backend == "none" else certify
    stone = {"bodies.stone": {"urdf": BALL, "base": "floating"}}
    words = {"solver.backend": backend, "solver.certify": certify}
    scenario = load_scenario("block_push", stone | words)
    simulator = scenario.simulator()
    first_step(scenario, simulator)
    q = scenario.system.q_start.copy()
    q[scenario.system.joint("stone/base").q.start] = np.nan
    with pytest.raises(qr.QuasistaticError, match="finite"):
        simulator.step(q, scenario.targets(scenario.h))


PLAIN = """
import sys, quasistatic_ref as qr
qr.load_scenario("sphere_spin", steps=1).run(findings=False)
print(*(name for name in sys.modules if name.startswith("quasistatic_ref")))
"""


def test_the_default_asks_for_nothing_of_daqp():
    imported = python("-c", PLAIN).stdout.split()
    assert "quasistatic_ref.solve.step_problem" in imported
    assert not any(name == "quasistatic_ref.optional.daqp.solver" for name in imported)


FAST = """
import sys, quasistatic_ref as qr
run = qr.load_scenario(sys.argv[1], steps=2, fast=True).run()
assert run.header.backend == "daqp"
print(*(name for name in sys.argv[2:] if name in sys.modules))
"""
LARGE = ("cvxpy", "jax", "matplotlib", "numpy.ma", "pandas", "scipy", "trimesh")


@pytest.mark.parametrize("name", ["bunny_grasp", "stack", "door"])
def test_a_fast_run_imports_no_large_package(name):
    assert python("-c", FAST, name, *LARGE).stdout.split() == []
