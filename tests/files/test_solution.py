"""Solutions as JSON: the documented fields, bit for bit; what is no solution is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    InputError,
    StepInfeasible,
    load_solution,
    save_step,
    solve_step,
    verify,
    verify_answer,
)
from quasistatic_ref.certify.verification import rounded_wrenches
from tests.cases import cases, refusal
from tests.closeness import assert_same, assert_within
from tests.errors.scene import changed
from tests.helpers import point_on_floor, random_step
from tests.made import infeasible_text, solution_text
from tests.tolerances import ROUNDING

PLAIN = random_step(11, n_a=2, n_u=3, rows=(6, 4))


@pytest.fixture
def claimed(tmp_path):
    """A solution as it is read from a file, of a text or of a record."""

    def load(claim, step=PLAIN):
        path = tmp_path / "solution.json"
        path.write_text(claim if isinstance(claim, str) else json.dumps(claim))
        return load_solution(path, step)

    return load


@pytest.mark.parametrize(
    ("certify", "kind"), [("full", "exact"), ("residual", "residual"), ("off", "none")]
)
def test_a_solution_read_back_is_the_same_bits(claimed, certify, kind):
    step = PLAIN.replace(extra=Extra(("a", "b"), np.eye(2, 5), np.full(2, -1.0)))
    solution = solve_step(step, certify=certify)
    back = claimed(solution_text(solution), step)
    assert back.certificate == replace(solution.certificate, residuals={})
    assert back.certificate.kind == kind
    assert_same(back.delta_q, solution.delta_q)
    lam = solution.lam
    assert_same(back.lam, lam)
    # Both are the same combination; the file's is rounded once.
    size = np.abs(solution.wrench).max()
    assert_within(back.wrench, solution.wrench, ROUNDING * size)


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_a_forged_wrench_is_refused_by_every_check(tmp_path, claimed, cli, cone):
    """Of a force of 1e6 N, all else being right: by verify, by verify_answer, by the command."""
    step = point_on_floor(force=(0.5, 0.0, -3.0)).replace(cone=cone)
    solution = solve_step(step)
    record = json.loads(solution_text(solution))
    record["wrench"][0][2] = 1e6
    claim = claimed(record, step)
    reason = verify(claim).reason
    assert reason.startswith("wrench[0][2] is 1000000.0; the exact one rounds to")
    certificate = claim.certificate
    answer = (step, claim.delta_q, certificate.active, claim.lam, certificate)
    assert verify_answer(*answer, wrench=claim.wrench).reason == reason
    assert verify_answer(*answer)
    said = cli(
        "verify", save_step(tmp_path / "step.json", step), tmp_path / "solution.json", status=1
    ).out
    assert said == f"refuted: {reason}\n"
    assert verify_answer(*answer, wrench=1.0).reason.startswith("wrench has shape ();")
    with pytest.raises(InputError, match=r"active: must be a list of \(contact, row\)"):
        verify_answer(step, claim.delta_q, 3)
    with pytest.raises(InputError, match="wrench: is a combination of lam: give lam, too"):
        verify_answer(step, claim.delta_q, certificate.active, wrench=claim.wrench)


def test_a_proof_that_there_is_no_solution_is_one_answer_of_a_file(claimed):
    """What the error of the step carries, written and read, is verified; a forged one is not."""
    walls = Extra(("up", "down"), np.eye(5)[:1] * [[1], [-1]], [1e-3, 1e-3])
    step = PLAIN.replace(extra=walls)
    with pytest.raises(StepInfeasible) as failure:
        solve_step(step)
    for exact in (failure.value.farkas.exact, ("1",) * step.m):
        claim = claimed(infeasible_text(step, exact), step)
        assert claim.delta_q is None
        assert bool(verify(claim)) == (exact == failure.value.farkas.exact)


SOLUTION_REFUSED = {
    "a later version": ("version", 3, "version: is not known here; this program reads 2"),
    "the name of a backend": ("backend", "daqp", "backend: is unknown"),
    "lam flat": ("lam", [0.0] * 10, "lam: must have one list for each of 2 contacts"),
    "lam of a wrong contact": ("lam/1", [0.0] * 6, "lam[1]: must be 4 numbers"),
    "active out of order": (
        "certificate/active",
        [[0, 1], [0, 0]],
        "certificate.active: must be in increasing",
    ),
}


@cases("path, value, says", SOLUTION_REFUSED)
def test_a_solution_with_a_wrong_field_is_refused(tmp_path, claimed, path, value, says):
    record = json.loads(solution_text(solve_step(PLAIN)))
    with refusal(InputError, f"{tmp_path / 'solution.json'}: {says}"):
        claimed(changed(record, (path, value)))


WRENCHES = {
    "a quarter of the least float64": (5e-324, 1.0, [0.0, 0.0, 5e-324, 0.0]),
    "beyond float64": (1e308, 0.01, [0.0, -np.inf, np.inf, 0.0]),
}
"""An impulse along -d2, over a time h: a wrench that is zero has no sign, an infinite one has."""


@cases("lam, h, expected", WRENCHES)
def test_a_wrench_is_rounded_as_any_number(lam, h, expected):
    contacts = point_on_floor(mu_v=0.25).contacts
    wrench = rounded_wrenches(contacts, np.array([0.0, 0.0, 0.0, lam]), h)
    assert_same(wrench, [expected])
    assert_same(np.signbit(wrench), [np.signbit(expected)])


@pytest.mark.parametrize("bound", [1e-9, None])
def test_a_file_with_a_bound_of_an_older_version_is_read_and_proves_nothing(
    tmp_path, claimed, cli, bound
):
    record = json.loads(solution_text(solve_step(PLAIN, certify="residual")))
    assert record["certificate"] == {"kind": "residual"}
    record["certificate"]["error_bound"] = bound
    step = save_step(tmp_path / "step.json", PLAIN)
    assert claimed(record).certificate.error_bound is None
    refuted = "refuted: a certificate of kind 'residual' proves nothing; solve with full\n"
    assert cli("verify", step, tmp_path / "solution.json", status=1).out == refuted
