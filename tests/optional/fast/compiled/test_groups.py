"""All groups of a step, proved in one call: the bits that the exact method finds for each group."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import csc_matrix

from quasistatic_ref import StepIllPosed, StepInfeasible, StepNotSolved
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.at_random import divided
from quasistatic_ref.lab.scenes.contacts import X, Y, Z, contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast import proofs
from quasistatic_ref.optional.fast.compiled.certificate import DECIDED, places
from quasistatic_ref.optional.fast.proofs import Proofs
from quasistatic_ref.solve.solver import NaturalAnswer, solver_for
from quasistatic_ref.solve.units import DenseStepInBothUnits
from quasistatic_ref.step.groups import Group
from quasistatic_ref.tolerances import ACCURACY
from tests.helpers import changed
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.grouped import unlike_fields
from tests.oracles.random_steps import any_step
from validation.make.confirmed_bits import NEARBY, OTHERS, differing_fields

pytestmark = needs_compiler


def by_the_exact_method(monkeypatch, both, answer):
    """The optimum as it is proved without compiled code, by proofs that have kept nothing."""
    with monkeypatch.context() as without:
        without.setattr(proofs, "why_not", lambda: "no compiler")
        return Proofs().optimum(both, answer)


def spoilt(rng, answer):
    """An answer of which some rows press, and others do not, that did otherwise."""
    lam = np.where(
        rng.random(len(answer.natural_lam)) < 0.1,
        rng.random(len(answer.natural_lam)),
        answer.natural_lam,
    )
    return NaturalAnswer(answer.natural_delta_q, lam, answer.statistics)


def test_groups_that_merge_and_split_have_the_bits_of_each_by_itself(monkeypatch):
    """Contacts come and go, coordinates are coupled in other ways, and some guesses are wrong.

    Of the contacts some are there twice, without friction, or exactly closed (`any_step`).
    """
    codes = Counter()
    several = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        whole = any_step(rng, 6, 12, 12)
        kept = Proofs()
        step = whole
        for k in range(8):
            if k % 2 == 0:  # so that every grouping stays for a step
                step = divided(rng, whole, int(rng.integers(1, 7)))
            away = np.where(rng.random(12) < 0.4, 1.0, 0.0)
            step = step.replace(contacts=changed(step.contacts, phi=whole.contacts.phi + away))
            both = DenseStepInBothUnits(step)
            try:
                answer = solver_for(step, "daqp", fast=True).answer(both, ACCURACY)
                answer = spoilt(rng, answer) if k % 4 == 3 else answer
                found = kept.optimum(both, answer)
            except (StepNotSolved, StepInfeasible, StepIllPosed):
                continue
            other = by_the_exact_method(monkeypatch, both, answer)
            may = NEARBY if found.multipliers_unique else OTHERS
            assert set(differing_fields(found, other)) <= may, (seed, k)
            assert unlike_fields(found, form_optimum(exact_form(step))) == [], (seed, k)
            of_groups = kept.prover.s["code"].tolist()
            codes.update(of_groups)
            several += len(of_groups) > 1
    assert codes[DECIDED] == codes.total() > 100
    assert several > 5


ROOT = np.sqrt(0.5)
PLANES = {
    "x": [Y, Z, X],
    "y": [Z, X, Y],
    "z": [X, Y, Z],
    "x > y": [ROOT * (X + Y), Z, ROOT * (X - Y)],
}


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # One floor implies the other; a wall in its place is closed as nothing pushes sideways.
        ((["z", "z"], -Z, [0]), (["z", "x"], -Z, [0])),
        # In a corner x = y; where the point is pushed out of it x = y, too, because of the push.
        ((["x", "y", "x > y"], -X - Y, [0, 4]), (["x", "y", "x > y"], X + Y, [])),
    ],
)
def test_zeros_are_not_taken_over_by_other_rows_or_another_guess(monkeypatch, before, after):
    """A point between planes without friction; before, the guess implies all gaps without slack."""
    kept = Proofs()
    smooth = []
    for planes, force, pressed in (before, before, after):
        J = np.zeros((len(planes), 4, 3))
        J[:, :3] = np.eye(3)
        contacts = contacts_of(0.0, [PLANES[name] for name in planes], J, 0.0)
        both = DenseStepInBothUnits(free_step(np.eye(3), force, contacts, 0.01))
        lam = np.zeros(both.si_step.m)
        lam[pressed] = 1.0
        answer = NaturalAnswer(np.zeros(3), lam, None)
        found = kept.optimum(both, answer)
        other = by_the_exact_method(monkeypatch, both, answer)
        assert set(differing_fields(found, other)) <= NEARBY
        smooth.append(found.differentiable)
    assert smooth == [True, True, False]


def test_a_group_that_nothing_presses_is_proved_on_the_rows_of_the_one_before():
    """Two points, each on two equal floors. An answer says that the second bears one."""
    J = np.zeros((4, 4, 6))
    J[:2, :3, :3] = J[2:, :3, 3:] = np.eye(3)
    contacts = contacts_of(0.0, [PLANES["z"]] * 4, J, 0.0)
    step = free_step(np.eye(6), [0, 0, -1, 0, 0, -1], contacts, 0.01)
    kept = Proofs()
    lam = np.zeros(step.m)
    lam[1] = 1.0
    kept.optimum(DenseStepInBothUnits(step), NaturalAnswer(np.zeros(6), lam, None))
    assert [proof.guess.tolist() for proof in kept.prover.proofs] == [[1], [1]]


def test_a_kept_zero_of_another_group_is_no_entry_of_a_group():
    """A keeps all entries of 2 rows and 4 columns, that of row r and column v at 2 v + r.

    The last coordinate is a group of its own, as it is where no contact moves with it.
    """
    contacts = SimpleNamespace(kept_J=np.zeros((1, 4, 4)), kept_columns=None)
    step = SimpleNamespace(m=2, n_v=4, contacts=contacts)
    none = np.zeros(0, dtype=np.int64)
    first = Group(np.arange(3), np.arange(1), none, np.arange(2))
    found = places(
        step, csc_matrix(np.ones((2, 4))), [first, Group(np.array([3]), none, none, none)]
    )
    assert found[0].in_A.tolist() == [[2 * v + r for v in range(3)] for r in range(2)]
    assert found[1].in_A.shape == (0, 1)
