"""The data of steps where a compiled function stands aside, and how many it forms."""

import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.compiled import leaves
from tests.simulate.test_form_step import SCENES, H, digest, formed, scene

pytestmark = pytest.mark.extra("compiled")

LEAVES = sorted(leaves.LEAVES)


@pytest.mark.parametrize("without", LEAVES)
def test_what_one_compiled_function_declines_has_the_same_bits(without, monkeypatch):
    with_all = digest(45)
    is_compiled = leaves.is_compiled
    monkeypatch.setattr(
        leaves, "is_compiled", lambda f: f.__qualname__ != without and is_compiled(f)
    )
    assert digest(45) == with_all


def test_compiled_code_forms_nearly_all_steps():
    assert sum(formed(*scene(seed)).formed is not None for seed in range(SCENES)) >= 285
    grasp = qr.load_scenario("bunny_grasp", ["solver.certify=off"], fast=True)
    simulator = grasp.simulator()
    end = grasp.system.q_start
    count = 0
    for k in range(40):
        result = simulator.step(end, grasp.targets(k * H))
        count += result.step.formed is not None
        end = result.end
    assert count >= 38
