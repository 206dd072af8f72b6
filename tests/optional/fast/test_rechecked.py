"""Proofs of compiled code that are checked again by the exact method."""

import re
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    RunFailed,
    StepIllPosed,
    StepInfeasible,
    load_scenario,
    solve_step,
)
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.slacks import KnownSlacks
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast import proofs, rechecked
from quasistatic_ref.optional.fast.compiled import certificate
from quasistatic_ref.optional.fast.rechecked import WrongProof, check, is_due
from tests.helpers import changed
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.random_steps import mixed_step

pytestmark = needs_compiler


@pytest.fixture
def first(monkeypatch):
    """No proof of any kind has been made."""
    monkeypatch.setattr(rechecked, "_proofs", type(rechecked._proofs)())


def test_the_first_of_a_kind_and_one_in_a_thousand_are_due(first):
    assert [k for k in range(2500) if is_due("a kind", 3)] == [0, 1000, 2000]
    assert not is_due("another kind", rechecked.LARGEST + 1)


@pytest.mark.parametrize("seed", [1, 5, 7])
def test_a_right_proof_passes_and_each_wrong_number_is_found(seed):
    step = mixed_step(seed)
    right = step_optimum(step)
    check(step, right)
    for name in ("delta_q", "net", "slack"):
        wrong = getattr(right, name).copy()
        wrong[0] = np.nextafter(wrong[0], np.inf)
        field = {"slacks": KnownSlacks(wrong)} if name == "slack" else {name: wrong}
        spoilt = replace(right, **field)
        with pytest.raises(WrongProof, match=f"compiled code has proved a step wrongly: {name} "):
            check(step, spoilt)


def test_a_solution_of_a_step_without_one_is_found():
    """Two walls, each one metre beyond the other."""
    n = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    J = np.zeros((2, 4, 1))
    J[:, 0, 0] = 1.0, -1.0
    walls = contacts_of(np.full(2, -1.0), np.array([n, n]), J, 0.0)
    step = free_step(np.eye(1), np.ones(1), walls, 0.01)
    some = step_optimum(step.replace(contacts=changed(walls, phi=np.zeros(2))))
    with pytest.raises(WrongProof, match="that it has a solution is not what"):
        check(step, some)


def test_a_run_ends_with_a_sentence_and_the_step(first, monkeypatch):
    plain = certificate.GroupProof.decided

    def wrong(proof):
        found = plain(proof)
        return None if found is None else replace(found, delta_q=2 * found.delta_q)

    monkeypatch.setattr(certificate.GroupProof, "decided", wrong)
    scenario = load_scenario("bunny_grasp", ["record=light", "steps=3"], fast=True)
    with pytest.raises(RunFailed, match="delta_q is not what the exact method finds") as failed:
        scenario.run(progress=False)
    assert re.search(r"\(compiler .+, library .+\.so\)", str(failed.value))
    assert solve_step(failed.value.step, "none").certificate.kind == "exact"


def test_every_kind_is_checked(first, monkeypatch):
    seen = []
    monkeypatch.setattr(proofs, "is_due", lambda kind, n: seen.append(kind) or True)
    for seed in range(40):
        with suppress(StepInfeasible, StepIllPosed):
            solve_step(mixed_step(seed), "daqp", fast=True)
    # Of two coordinates one has a contact, the other a row of a user's own, which C does not know.
    J = np.zeros((1, 4, 2))
    J[0, 2, 0] = 1.0
    floor = contacts_of(0.0, np.eye(3)[None], J, 0.0)
    own = Extra(("own",), [[0.0, 1.0]], [1.0])
    step = free_step(np.eye(2), -np.ones(2), floor, 0.01).replace(extra=own)
    solve_step(step, "daqp", fast=True)
    assert set(seen) == {rechecked.WHOLE, rechecked.GROUP}
