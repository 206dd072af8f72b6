"""Groups: what of a step is coupled, and the same optimum from its parts."""

import json

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    StepIllPosed,
    StepInfeasible,
    contact_forces,
    solve_step,
)
from quasistatic_ref.certify.degeneracy import form_degeneracy
from quasistatic_ref.certify.groups import flat_rows, group_steps, groups
from quasistatic_ref.certify.step_program import StepProgram
from tests.helpers import two_bodies
from tests.made import X, contacts_of, free_step, infeasible_text
from tests.oracles.random_steps import drawn
from tests.oracles.solution_truth import refuted, solution_file


def test_random_steps_without_some_couplings_have_the_optimum_of_their_groups():
    """As a checker proves that knows no groups; what is unique of them is so of the whole."""
    several = 0
    for seed in range(25):
        step = drawn(seed, "mixed classes")
        several += len(groups(step)) > 1
        text = solution_file(step)
        assert refuted(step, text) == [], seed
        if claims := json.loads(text).get("certificate"):
            facts = form_degeneracy(StepProgram(step), flat_rows(step, claims["active"]))
            assert facts._asdict().items() <= claims.items(), seed
    assert several > 12


def parts_of(step):
    """The coordinates, contacts, own rows and all rows of each group."""
    names = "coordinates", "contacts", "extra_rows", "rows"
    return [tuple(getattr(group, name).tolist() for name in names) for group in groups(step)]


def test_contacts_own_rows_and_inertia_couple_coordinates_and_nothing_else():
    J = np.zeros((2, 4, 5))
    J[0, 3, 4] = J[0, 0, 1] = 1.0  # the first contact moves with 1 and 4; the second with nothing
    frames = np.tile(np.eye(3), (2, 1, 1))
    M = np.eye(5)
    M[0, 3] = M[3, 0] = 0.5
    step = free_step(M, np.ones(5), contacts_of(0.0, frames, J, 0.5), 0.01)
    of_c0, of_c1 = [0, 1, 2, 3], [4, 5, 6, 7]
    free = [2], [], [], []
    assert parts_of(step) == [([0, 3], [1], [], of_c1), ([1, 4], [0], [], of_c0), free]
    own = Extra(("a", "b"), [[0, 0, 0, 0, 0.0], [0, 0, 1, 0, 1]], [-1.0, -1.0])
    tied = [([0, 3], [1], [0], [*of_c1, 8]), ([1, 2, 4], [0], [1], [*of_c0, 9])]
    assert parts_of(step.replace(extra=own)) == tied
    parts = [part.extra.A.tolist() for _, part in group_steps(step.replace(extra=own))]
    assert parts == [[[0, 0]], [[0, 1, 1]]]


def test_a_group_without_solution_is_named_by_its_contacts():
    step = two_bodies([X, -X], [-1e-3, -1e-3], np.ones(6))
    for solved in (solve_step, contact_forces):
        with pytest.raises(StepInfeasible) as failure:
            solved(step)
        farkas = failure.value.farkas
        assert set(farkas.owners) == {"c0", "c1"}
        assert refuted(step, infeasible_text(step, farkas.exact)) == []
        assert failure.value.step is step


def test_a_wedged_light_body_is_ill_posed_also_next_to_a_heavy_one_that_falls():
    """Walls at 1 mm whose normals are opposite but for 2^-20: the way out is 2^20 times as long.

    The first body falls by h^2 f = 1e8 * 1e-4 m meanwhile, 1e4 m, a tenth of which is more.
    """
    n = np.array([1.0, 2.0**-20, 0.0])
    m = np.array([-1.0, 2.0**-20, 0.0])
    unit = np.linalg.norm(n)
    step = two_bodies([n / unit, m / unit], -1e-3, [0, 0, -1e8, 0, 0, 0])
    with pytest.raises(StepIllPosed) as failure:
        solve_step(step, "none")
    assert abs(failure.value.delta_q[4]) > 1e-3 * 2**19
    assert np.abs(failure.value.delta_q[:3]).max() > 1e3
