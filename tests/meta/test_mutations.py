"""A wrong sign, comparison or index in the paper's page or in the judge makes a test fail.

The mutants are generated (validation/tools/mutating/mutants.py); these are a fixed sample of them.
All of them: ``python -m validation.tools.mutations``.
"""

import json
import os
import subprocess
import sys

from validation.tools.mutating.mutants import mutants
from validation.tools.mutating.mutated import TESTS
from validation.tools.mutations import PACKAGE, all_mutants

PAGE, FORM = "step/problem.py", "step/standard_form.py"
CONES, FRICTION, ELLIPSOID = "step/cones.py", "step/friction.py", "optional/ellipsoid/cone.py"
JUDGE = "certify/optimality.py"
RATIONAL, DEPENDENCE = "certify/rational.py", "certify/dependence.py"
POINT, ROUNDING, EXACT = "certify/point.py", "certify/rounding.py", "certify/exact.py"
FARKAS, CLAIMS = "certify/farkas.py", "certify/certificate.py"

SAMPLE = (
    f"{PAGE} StepProblem.__init__: gap + slip_1 -> gap - slip_1",
    f"{PAGE} StepProblem.__init__: gap - slip_2 -> gap + slip_2",
    f"{PAGE} StepProblem.__init__: gap - spin -> gap + spin",
    f"{PAGE} StepProblem.__init__: tau_k + tau_a -> tau_k - tau_a",
    f"{CONES} pyramid: gap + slip_2 -> gap - slip_2",
    f"{CONES} pyramid: gap - slip_1 -> gap + slip_1",
    f"{CONES} pyramid: gap + spin -> gap - spin",
    f"{FRICTION} rows_along: mu_omega * J_w -> mu_omega / J_w",
    f"{FRICTION} wrenches: [mu_v * f_d1, mu_v * f_d2, f_n, mu_omega * tau_n] -> "
    "[mu_v * f_d2, mu_v * f_d1, f_n, mu_omega * tau_n]",
    f"{FRICTION} row_gaps: cone(name).matrix[:, 0] -> cone(name).matrix[:, 1]",
    f"{FORM} standard_form: -row_gaps(step.contacts, step.cone)[step.mask] -> "
    "row_gaps(step.contacts, step.cone)[step.mask]",
    f"{FORM} linear_term: tau_k + step.tau_a -> tau_k - step.tau_a",
    f"{FORM} standard_form: [A, step.extra.A] -> [step.extra.A, A]",
    f"{CONES} row_violations: -slack -> slack",
    f"{ELLIPSOID} cone_violations: mu * s[:, 1:] -> mu / s[:, 1:]",
    f"{ELLIPSOID} cone_violations: -own_lam -> own_lam",
    f"{CONES} row_violations: -lam -> lam",
    f"{JUDGE} optimality_residuals: A @ delta_q - b -> A @ delta_q + b",
    f"{RATIONAL} friction_rows: mu[:, 2:, None] -> mu[:, 2 + 1:, None]",
    f"{RATIONAL} contact_motion: [contacts.n[which], contacts.d1[which], contacts.d2[which]] -> "
    "[contacts.n[which], contacts.d2[which], contacts.d1[which]]",
    f"{RATIONAL} in_integers: two_to(H.e + e_x) / h -> two_to(H.e + e_x) * h",
    f"{POINT} rational_solution: -form.A[i, j] -> form.A[i, j]",
    f"{DEPENDENCE} combination: solution[j, 0] -> solution[0, j]",
    f"{POINT} equality_solution: balls.A * x - balls.b -> balls.A * x + balls.b",
    f"{POINT} Point.zero_coordinates: i == v -> i != v",
    "cli/decimals.py decimal_string: exponent - digits + 1 -> exponent - digits - 1",
    f"{ROUNDING} nearest_in: low == high -> low != high",
    f"{EXACT} _rounded: signs == 0 -> signs != 0",
    f"{FARKAS} farkas_refutation: y_i < 0 -> y_i > 0",
    f"{FARKAS} farkas_refutation: (row * form.b)[0, 0] > 0 -> (row * form.b)[0, 0] >= 0",
    f"{CLAIMS} _wrong_sign: slack_i < 0 -> slack_i > 0",
    f"{CLAIMS} _wrong_sign: lam_i <= 0 -> lam_i < 0",
    f"{DEPENDENCE} idle_rows: i not in working -> i in working",
)
NOTICING = (
    "test_cvxpy_compiles",
    "test_each_row_alone_reaches_a_vertex_of_the_octahedron",
    "test_the_directions_of_a_contact_add_up_to_nothing",
    "test_the_gap_adds_to_the_motion_along_the_normal_of_an_ellipsoid",
    "test_a_planted_optimum_has_no_residual",
    "test_impulses_outside_an_ellipsoid_are_its_dual_residual",
    "test_rows_of_the_user_beside_an_ellipsoid_are_judged_one_by_one",
    "test_grasp_step_has_the_size_of_the_paper",
    "test_step_is_formed_without_rounding",
    "test_small_coefficients_are_read_from_their_residues",
    "test_claims_of_a_sticking_body_are_checked",
    "test_false_claims_are_refused",
    "test_a_row_without_multiplier_is_in_no_working_set",
    "test_half_way_values_round_to_even",
    "test_grasp_is_decided_by_balls_alone",
    "test_limit_of_friction_is_a_kink",
    "test_decimal_strings_round_half_to_even",
    "test_ball_across_a_half_way_point_has_no_float64",
    "test_false_proofs_are_refused_with_a_reason",
    "test_walls_that_overlap_are_infeasible_and_named",
)
"""The tests that the sample meets: each of them notices some of it, and together all of it. To run
every test once, in a fork that is watched, takes longer than to try the mutants."""

TRIED = """
import json, sys
from validation.tools.mutations import TESTS, all_mutants, outcomes
keys, found = json.load(sys.stdin), {}
tests = {file: all_of_it[:1] for file, all_of_it in TESTS.items()}
known = {m.key: m for m in all_mutants(sorted({key.split()[0] for key in keys}))}
outcomes([known[key] for key in keys], lambda m, said: found.update({m.key: said}), tests=tests)
open(sys.argv[1], "w").write(json.dumps(found))
"""


def test_every_mutant_of_the_sample_is_killed(tmp_path):
    """One test, and one process: to collect the tests takes longer than to run them."""
    known = {mutant.key for mutant in all_mutants(sorted({key.split()[0] for key in SAMPLE}))}
    gone = [key for key in SAMPLE if key not in known]
    assert not gone, f"no longer mutants of the package, renew them: {gone}"
    found, chosen = tmp_path / "found.json", f"-k '{' or '.join(NOTICING)}'"
    subprocess.run(
        [sys.executable, "-c", TRIED, str(found)], input=json.dumps(SAMPLE), text=True,
        cwd=PACKAGE.parent, env=os.environ | {"CI": "1", "PYTEST_ADDOPTS": chosen}, check=True,
        capture_output=True,
    )  # fmt: skip
    said = json.loads(found.read_text())
    assert set(said) == set(SAMPLE)
    assert not [key for key in SAMPLE if said[key] == "survived"]


def test_every_file_of_the_mathematics_has_its_tests_named():
    folders = ("step", "certify", "solve", "shapes", "model", "contact")
    files = {path for folder in folders for path in (PACKAGE / folder).rglob("*.py")}
    with_mutants = {
        str(path.relative_to(PACKAGE))
        for path in files
        if next(mutants(str(path.relative_to(PACKAGE)), path.read_text()), None)
    }
    assert with_mutants <= set(TESTS)
    assert [name for name in TESTS if not (PACKAGE / name).is_file()] == []
    for tests in TESTS.values():
        for test in tests:
            assert (PACKAGE.parent / "tests" / test).exists(), test
