"""Answers to ordinary and strange steps are right by fractions; `verify` accepts their files."""

import json
from fractions import Fraction
from itertools import cycle, pairwise

import numpy as np
import pytest

from quasistatic_ref.cli.certificate_words import in_words
from quasistatic_ref.cli.solution_files import infeasible_text, solution_read, solution_text
from quasistatic_ref.cli.verify import refutation
from quasistatic_ref.errors import InputError, QuasistaticError, StepInfeasible
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast import solver as fast_solvers
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver, solver_for
from quasistatic_ref.step.files import step_read, step_text
from tests.oracles.attacked_steps import FAMILIES, positive_definite, singular, steps
from tests.oracles.random_steps import any_step
from tests.oracles.solution_truth import (
    Judge,
    combinations,
    program,
    proof,
    proved,
    rounded,
    wrenches,
)

BACKENDS = ("daqp", "clarabel", "osqp", "piqp", "quadprog")
COUNT = 2
"""Of each family."""


@pytest.fixture
def refused(tmp_path):
    """Why `verify` refuses a step and a solution, in words; None if it does not."""

    def reason(step, solution):
        paths = [tmp_path / "step.json", tmp_path / "solution.json"]
        for path, text in zip(paths, (step_text(step), solution), strict=True):
            path.write_text(text)
        posed = step_read(paths[0])
        return refutation(posed, solution_read(paths[1], posed))

    return reason


def solution_file(step, backend, certify):
    """The solution file of a step."""
    try:
        solver = solver_for(step, backend, fast=backend != NONE)
        return solution_text(solve_step(step, solver, certify=certify))
    except StepInfeasible as said:
        return infeasible_text(step, said.farkas.exact)


def files(family, backends, certify, claims):
    """As many steps of a family as are asked for, with files that claim something."""
    found = []
    for backend, step in zip(cycle(backends), steps(family), strict=False):
        try:
            text = solution_file(step, backend, certify)
        except QuasistaticError:
            continue
        if claims(record := json.loads(text)):
            found.append((step, text, record))
        if len(found) == COUNT:
            break
    return found


def right_file(step, record):
    """What of an exact solution file fractions decide, from the working set that it names."""
    of, sizes = program(step), [len(rows) for rows in combinations(step)]
    starts = np.cumsum([0, *sizes]).tolist()
    working = [starts[j] + i for j, i in record["certificate"]["active"]]
    x, lam_w, slack = proved(of, working)
    lam = [0.0] * len(of[3])
    for i, value in zip(working, lam_w, strict=True):
        lam[i] = rounded(value)
    by_contact = [lam[a:b] for a, b in pairwise(starts)]
    known = {"smallest_active_multiplier": min(map(rounded, lam_w), default=None)}
    if record["certificate"]["differentiable"]:
        open_ = [rounded(s) for s in slack if s]
        known["smallest_inactive_slack"] = min(open_, default=None)
    return record | {
        "delta_q": [*map(rounded, x)],
        "lam": by_contact,
        "lam_extra": lam[starts[-1] :],
        "wrench": wrenches(step, by_contact),
        "certificate": record["certificate"] | known | {"error_bound": 0.0},
    }


@pytest.mark.parametrize("family", FAMILIES)
def test_exact_answers_are_those_of_fractions(refused, family):
    for step, text, record in files(family, (NONE,), "full", lambda _: True):
        if record["status"] == "infeasible":
            assert proof(step, [Fraction(y) for y in record["farkas"]])
        else:
            assert json.dumps(right_file(step, record)) == json.dumps(record)
        assert refused(step, text) is None


def bound_of(record):
    return record["certificate"]["error_bound"] if "certificate" in record else None


@pytest.mark.parametrize("family", FAMILIES)
def test_bounds_hold_by_fractions(refused, family):
    """Of backends' own answers."""
    for step, text, record in files(family, BACKENDS, "residual", bound_of):
        judged = Judge(step, record)
        square = judged.off(record) + 2 * judged.gap(record) / judged.free
        assert square <= Fraction(bound_of(record)) ** 2 <= 1
        assert record["wrench"] == wrenches(step, record["lam"])
        assert refused(step, text) is None


def test_no_nearly_singular_matrix_is_judged_wrongly(refused, tmp_path):
    said, path = [], tmp_path / "step.json"
    for seed in range(12):
        rng = np.random.default_rng(seed)
        n, n_c = int(rng.integers(1, 8)), int(rng.integers(0, 4))
        key = ("K_q", "M_u")[seed % 2]
        S, step = singular(rng, n), any_step(rng, *((n, 0) if key == "K_q" else (0, n)), n_c)
        path.write_text(json.dumps(json.loads(step_text(step)) | {key: S.tolist()}))
        said.append(positive_definite(S))
        if not said[-1]:
            with pytest.raises(InputError, match="must be positive definite"):
                step_read(path)
            continue
        read = step_read(path)
        try:
            text = solution_file(read, NONE, "full")
        except QuasistaticError:
            continue
        assert refused(read, text) is None
    assert {True, False} == set(said)


@pytest.mark.parametrize("tau", [1e-323, 1e-312])
def test_the_bound_of_a_subnormal_answer_is_of_the_answer_as_given(refused, tau):
    """A mass of 3 kg in a second: x* = tau / 3, of which delta_q has few digits."""
    step = free_step(np.array([[3.0]]), np.array([tau]), no_contacts(1), 1.0)
    solution = solve_step(step, solver_for(step, "daqp", fast=True), certify="residual")
    error = abs(Fraction(solution.delta_q[0]) / (Fraction(tau) / 3) - 1)
    assert Fraction(solution.certificate.error_bound) >= error
    assert refused(step, solution_text(solution)) is None


def test_a_bound_above_one_is_no_useful_bound(monkeypatch):
    step = free_step(np.eye(1), np.ones(1), no_contacts(1), 1.0)
    monkeypatch.setattr(fast_solvers, "BOUNDED", -1.0)
    for bound, said in ((1.0, 1.0), (np.nextafter(1.0, 2.0), None), (3e276, None), (np.inf, None)):
        monkeypatch.setattr(Solver, "error_bound", lambda *_, bound=bound: bound)
        solver = solver_for(step, "daqp", fast=True)
        certificate = solve_step(step, solver, certify="residual").certificate
        assert certificate.error_bound == said
        assert ("no useful bound" in in_words(certificate)) == (said is None)
