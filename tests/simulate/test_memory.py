"""Memory: certified steps leave nothing behind, and a record is as large as its arrays."""

import gc
import tracemalloc

import numpy as np
import pytest

from quasistatic_ref import Body, Recorder, Sphere, System, load_scenario
from quasistatic_ref.simulate.recorder import PACKED
from tests.processes import python

GROWTH = """
import gc, tracemalloc
import numpy as np
from quasistatic_ref import load_scenario

scenario, draw = load_scenario("sphere_spin", fast=True), np.random.default_rng(1)
simulator, q, force = scenario.simulator(), scenario.system.q_start, np.zeros(6)
tracemalloc.start()
for k in range(1, 1001):
    force[5] = 0.147 * draw.random()
    q = simulator.step(q, np.zeros(0), force).q
    if k in (600, 1000):
        gc.collect()
        print(tracemalloc.get_traced_memory()[0])
"""
"""Allocated bytes after 600 and 1,000 steps, each under another torque about the normal, of at most
0.147 N m as in the scenario. In a process of its own: what other tests have put in Python's free
lists would be counted, too."""
LEFT = 50.0
"""Bytes that a step may leave between the 600th and the 1,000th, where NumPy still fills its cache
of small arrays: 11 to 26 were seen; one number that is kept in a dictionary takes more than 60."""
STEPS = 2 * PACKED
APIECE = 80
"""Bytes a step beyond its numbers: of names and heads of arrays, once in PACKED steps."""


@pytest.mark.long
def test_certified_steps_leave_nothing_behind():
    before, after = map(int, python("-c", GROWTH).stdout.split())
    assert (after - before) / (1000 - 600) < LEFT


@pytest.mark.long
def test_a_recorder_holds_what_its_trajectory_does_and_a_few_numbers_more():
    scenario = load_scenario("sphere_spin", record="full", fast=True)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    target = np.zeros(0)
    recorder = Recorder(simulator, q, "full")
    held = []
    tracemalloc.start()
    for k in range(2 * STEPS):
        recorder.add(target, simulator.step(q, target))
        if (k + 1) % STEPS == 0:
            gc.collect()
            held.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    grown = held[1] - held[0]
    arrays = sum(array.nbytes for array in recorder.trajectory().arrays.values()) / 2
    # tau and momentum; gap, motion and compliance of each contact; two artifacts, six wall times.
    n = scenario.system.n_v + scenario.system.n_u
    more = 8 * (n + 6 * simulator.plan.layout.rows.size + 2 + 6)
    assert grown < arrays + STEPS * (more + APIECE)


def test_loads_of_many_bodies_form_no_jacobian_of_all_links():
    system = System([Body.of_shape(f"b{i}", Sphere(0.1), 1.0, xyz=(i, 0, 0)) for i in range(60)])
    tracemalloc.start()
    for body in system.bodies:
        force = system.load(system.q_start, body.name, (1.0, 0.0, 0.0))
        assert force.sum() == 1.0
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 8 * len(system.links) * 6 * system.n_v / 2
