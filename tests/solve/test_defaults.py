"""Which backend a run has that names none."""

import subprocess
import sys

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.bench.scenes import cubes
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.optional.fast.adapters.daqp import Daqp
from quasistatic_ref.optional.fast.adapters.piqp import Piqp
from quasistatic_ref.optional.fast.backends import (
    EntriesOfJ,
    default_backend,
    entries_of_J,
    sparse_from,
)
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.tolerances import (
    DENSE_BELOW,
    DENSE_BELOW_PROOFS,
    SPARSE_FROM_DAQP,
    SPARSE_FROM_PIQP,
)
from tests.helpers import error
from tests.tolerances import OPTIMUM

LARGE = EntriesOfJ(10**9, 10**9)
FAILED = Reply(None, None, False, "at a loss")


@pytest.mark.extra("fast")
def test_the_default_of_fast_and_rows_is_daqp_then_piqp():
    by_certify = {"off": DENSE_BELOW, "residual": SPARSE_FROM_PIQP, "full": DENSE_BELOW_PROOFS}
    for certify, least in by_certify.items():
        of_one_group = [EntriesOfJ(n, n) for n in (least - 1, least)]
        assert default_backend("pyramid", certify, of_one_group[0]) == "daqp"
        assert default_backend("product", certify, of_one_group[1]) == "piqp"
    assert sparse_from("piqp", "product") == SPARSE_FROM_PIQP
    assert sparse_from("daqp", "product") == SPARSE_FROM_DAQP
    assert sparse_from("quadprog", "product") == sparse_from("piqp", "ellipsoid") == 0
    assert sparse_from("qpsolvers:piqp", "product") == 0
    few = pile((2, 1, 1), certify="residual")
    many = pile((8, 1, 1), certify="residual")
    for some, named in ((few, "daqp"), (many, "piqp")):
        own = some.simulator
        made = Simulator(own.system, own.pairs, h=own.h, K_q=own.K_q, certify="residual", fast=True)
        answer = made.step(some.q, np.zeros(0), some.force).solution
        assert (made.backend, answer.backend) == (named, named)
        assert answer.certificate.error_bound < 1e-4


@pytest.mark.extra("fast")
def test_bodies_that_cannot_touch_count_one_by_one():
    """3 stacks of 2 cubes, 4 contacts below each cube: 24 contacts and 36 coordinates, or 8 and 12.

    J has four rows a contact. Under another law than the model's contacts are never in blocks.
    """
    made = cubes(stacks=3, height=2, rows=6, push="rest").simulator("off", True)
    here = EntriesOfJ(4 * 24 * 36, 4 * 8 * 12, 12)
    assert entries_of_J(made.system, made.pairs, ordinary=True) == here
    assert entries_of_J(made.system, made.pairs, ordinary=False) == EntriesOfJ(0, 0)
    assert entries_of_J(made.system, [], ordinary=True) == EntriesOfJ(0, 0, 1)


@pytest.mark.extra("fast")
def test_the_default_backend_is_clarabel_and_with_fast_daqp():
    assert default_backend("facets-8", "full", EntriesOfJ()) == "daqp"
    assert default_backend("ellipsoid", "off", LARGE) == "clarabel"
    for settings, named in (
        ({}, "clarabel"),
        ({"fast": True}, "daqp"),
        ({"fast": True, "cone": "ellipsoid"}, "clarabel"),
        ({"fast": True, "solver.backend": "osqp"}, "osqp"),
        ({"solver.backend": "osqp"}, "osqp"),
    ):
        scenario = load_scenario("sphere_spin", settings)
        assert scenario.backend == scenario.simulator().backend == named


WITHOUT_DAQP = """
import sys
sys.modules["daqp"] = sys.modules["piqp"] = None
from quasistatic_ref import load_scenario
from quasistatic_ref.optional.fast.backends import EntriesOfJ, default_backend
from quasistatic_ref.cli.main import main
run = load_scenario("sphere_spin", steps=2, fast=True).run(progress=False)
print(run.header["backend"], *run["certificate"], main(["bench", "--out", sys.argv[1]]))
print(*(default_backend("pyramid", "off", EntriesOfJ(n, n)) for n in (0, 10**9)))
"""


def test_without_daqp_and_piqp_clarabel_takes_their_place_but_in_bench(tmp_path):
    command = [sys.executable, "-c", WITHOUT_DAQP, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "clarabel exact exact 2\nclarabel clarabel\n"
    assert "pip install daqp" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.extra("fast")
@pytest.mark.parametrize("by_code", [True, False])
def test_clarabel_takes_steps_on_which_the_default_backend_fails(monkeypatch, by_code):
    scenario = load_scenario("sphere_spin", ["solver.certify=off"], fast=True)
    simulator = scenario.simulator()
    honest = Daqp.reply
    q = scenario.system.q_start
    simulator.by_c = by_code
    backends = []
    for k in range(4):
        fails = k in (1, 2)
        monkeypatch.setattr(Daqp, "reply", (lambda *_: FAILED) if fails else honest)
        result = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
        optimum = solve_step(result.step, "none").delta_q
        assert error(result.step, result.solution.delta_q, optimum) <= OPTIMUM
        backends.append(result.solution.backend)
        q = result.q
    assert backends == ["daqp", "clarabel", "clarabel", "daqp"]


@pytest.mark.extra("fast")
def test_a_failure_of_a_backend_that_is_asked_on_its_own_word_is_that_backend_s(monkeypatch):
    monkeypatch.setattr(Piqp, "reply", lambda *_: FAILED)
    settings = ["solver.certify=off", "solver.backend=piqp"]
    scenario = load_scenario("sphere_spin", settings, fast=True)
    with pytest.raises(StepNotSolved, match="piqp did not solve the step"):
        scenario.simulator().step(scenario.system.q_start, scenario.targets(scenario.h))


@pytest.mark.extra("fast")
def test_a_simulator_that_names_no_backend_takes_curved_extensions():
    scenario = load_scenario("sphere_spin")
    simulator = Simulator(
        scenario.system, scenario.pairs, h=scenario.h, K_q=scenario.K_q, fast=True
    )
    assert simulator.backend == "daqp"  # which takes rows only
    simulator.extension = lambda q: Extension(lambda s: [cp.norm(s.delta_q) <= 1.0])
    answer = simulator.step(scenario.system.q_start, scenario.targets(scenario.h)).solution
    assert (answer.backend, answer.certificate.kind) == ("clarabel", "residual")
