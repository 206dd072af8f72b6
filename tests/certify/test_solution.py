"""Certificates are data, and verification believes nothing in them."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import Extra, StepDataError, solve_step, verify, verify_answer
from quasistatic_ref.certify.groups import contact_rows, flat_rows
from tests.helpers import point_on_floor, resting_point
from tests.made import solution_text
from tests.oracles.random_steps import drawn


@pytest.fixture(scope="module")
def step():
    step = drawn(11, "grasp")
    row = np.zeros((2, step.n_v))
    row[:, 6] = [1.0, -1.0]  # the gripper stays a little more open than it would
    least = solve_step(step).delta_q[6] + 1e-6
    return step.replace(extra=Extra(("close", "open"), row, [least, -1.0]))


def test_rows_have_a_contact_and_a_number_in_it(step):
    rows = range(step.m)
    pairs = contact_rows(step, rows)
    assert pairs[0] == (0, 0)
    assert pairs[59:61] == ((9, 5), (10, 0))  # ten contacts of six rows, then four each
    assert pairs[-3:] == ((14, 3), (15, 0), (15, 1))
    assert flat_rows(step, pairs) == tuple(rows)
    for none in ((0, 6), (10, 4), (15, 2), (16, 0), (-1, 0), (0, -1)):
        with pytest.raises(IndexError, match=f"no row {none[1]} of contact {none[0]}"):
            flat_rows(step, [none])


@pytest.mark.parametrize("touching", ["a row of one's own", "a contact"])
def test_a_row_without_multiplier_is_in_no_working_set(touching):
    """It would hold on one side only: delta_q is not differentiable, whatever set it is in.

    The unconstrained step of 0.75 m just touches x >= 0.75; or a body at rest on a smooth floor
    that nothing presses on, whose rows are four equal ones.
    """
    step = resting_point(tau_x=3.0, contacts=0)
    step = step.replace(extra=Extra(("touched",), np.eye(4)[:1], [0.75]))
    step = step if touching != "a contact" else point_on_floor(mu_v=0.0)
    solution = solve_step(step, "none")
    claims = solution.certificate
    assert claims.active == ()
    assert not claims.differentiable
    assert verify(solution)
    smooth = replace(claims, differentiable=True)
    assert "differentiable" in verify(replace(solution, certificate=smooth)).reason
    wider = replace(claims, active=((0, 0),), smallest_active_multiplier=0.0)
    assert "is zero" in verify(replace(solution, certificate=wider)).reason


@pytest.mark.parametrize("certify", ["full", "residual"])
@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_a_certificate_says_which_step_it_is_about(cone, certify):
    step = point_on_floor(force=(0.1, 0.0, -1.0)).replace(cone=cone)
    other = step.replace(tau_u=[0.1, 0.0, -1.0 - 2**-52])
    solution = solve_step(step, certify=certify)
    claims = solution.certificate
    assert claims.step_sha256 == json.loads(solution_text(solution))["step_sha256"]
    for same in (step, step.replace(), pickle.loads(pickle.dumps(step))):
        assert pickle.loads(pickle.dumps(claims)).is_of(same)
    verdict = verify_answer(other, solution.delta_q, claims.active, solution.lam, claims)
    assert verdict.reason == "the certificate is of another step"


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_lists_are_verified_as_arrays_are(cone):
    step = point_on_floor(force=(0.1, 0.0, -1.0)).replace(cone=cone)
    solution = solve_step(step)
    certificate = solution.certificate
    lists = solution.delta_q.tolist(), certificate.active, solution.lam.tolist(), certificate
    assert verify_answer(step, *lists)
    assert verify(solution)
    moved = verify(replace(solution, delta_q=np.nextafter(solution.delta_q, 1)))
    assert "delta_q" in moved.reason
    with pytest.raises(StepDataError, match=r"^delta_q: "):
        verify_answer(step, "12", certificate.active)
