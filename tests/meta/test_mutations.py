"""A wrong sign, comparison or index in the paper's page or in the judge makes a test fail.

The mutants are generated (validation/tools/mutating/mutants.py); these are a fixed sample of them.
All of them: ``python -m validation.tools.mutations``.
"""

from collections import Counter

from validation.tools.mutating.mutants import mutants
from validation.tools.mutating.mutated import TESTS
from validation.tools.mutations import PACKAGE, all_mutants, outcomes, reasons, tried_files

PAGE = "step/problem.py"
FORM = "step/standard_form.py"
CONES = "step/cones.py"
FRICTION = "step/friction.py"
ELLIPSOID = "optional/ellipsoid/cone.py"
JUDGE = "certify/residuals.py"
RATIONAL = "certify/rational.py"
DEPENDENCE = "certify/dependence.py"
MINIMISER = "certify/minimiser.py"
ROUNDING = "certify/rounding.py"
EXACT = "certify/exact.py"
FARKAS = "certify/farkas.py"
CLAIMS = "certify/certificate.py"

SAMPLE = {
    "step/test_standard_form.py": (
        f"{PAGE} StepProblem.__init__: gap + slip_1 -> gap - slip_1",
        f"{PAGE} StepProblem.__init__: gap - slip_2 -> gap + slip_2",
        f"{PAGE} StepProblem.__init__: gap - spin -> gap + spin",
        f"{PAGE} StepProblem.__init__: tau_k + tau_a -> tau_k - tau_a",
        f"{FORM} inequalities: [A, [step.extra.A for step in steps]] -> "
        "[[step.extra.A for step in steps], A]",
    ),
    "step/test_friction.py::test_each_row_alone_reaches_a_vertex_of_the_octahedron": (
        f"{FRICTION} wrenches: [1, 2, 0, 3] -> [2, 1, 0, 3]",
    ),
    "certify/test_residuals.py::test_a_planted_optimum_has_no_residual": (
        f"{FORM} inequalities: -first.present(row_constants(contacts, first.cone), len(steps)) -> "
        "first.present(row_constants(contacts, first.cone), len(steps))",
        f"{FORM} linear_term: tau_k + step.tau_a -> tau_k - step.tau_a",
        f"{CONES} row_violations: -slack -> slack",
        f"{CONES} row_violations: -lam -> lam",
        f"{JUDGE} optimality_residuals: A @ delta_q - b -> A @ delta_q + b",
    ),
    "certify/test_residuals.py::test_impulses_outside_an_ellipsoid_are_its_dual_residual": (
        f"{ELLIPSOID} cone_violations: mu * s[:, 1:] -> mu / s[:, 1:]",
    ),
    "certify/test_residuals.py::test_rows_of_the_user_beside_an_ellipsoid_are_judged_one_by_one": (
        f"{ELLIPSOID} cone_violations: -own_lam -> own_lam",
    ),
    "certify/test_certificate.py::test_claims_of_a_sticking_body_are_checked": (
        f"{CONES} pyramid: gap + slip_2 -> gap - slip_2",
        f"{CONES} pyramid: gap + spin -> gap - spin",
        f"{FRICTION} rows_along: mu_omega * J_w -> mu_omega / J_w",
        f"{RATIONAL} exact_friction_rows: mu[:, 2:, None] -> mu[:, 2 + 1:, None]",
        f"{MINIMISER} rational_solution: -a[i] -> a[i]",
        f"{DEPENDENCE} combination: solution[j, 0] -> solution[0, j]",
        f"{MINIMISER} equality_solution: form.A * x - form.b -> form.A * x + form.b",
        f"{ROUNDING} nearest_in: low == high -> low != high",
        f"{EXACT} _rounded: signs == 0 -> signs != 0",
    ),
    "certify/test_certificate.py::test_false_claims_are_refused": (
        f"{CLAIMS} _wrong_sign: slack_i < 0 -> slack_i > 0",
    ),
    "certify/test_certificate.py::test_a_row_without_multiplier_is_in_no_working_set": (
        f"{CLAIMS} _wrong_sign: lam_i <= 0 -> lam_i < 0",
        f"{DEPENDENCE} tight_rows: i not in working -> i in working",
    ),
    "certify/test_exact.py::test_limit_of_friction_is_a_kink": (
        f"{CONES} pyramid: gap - slip_1 -> gap + slip_1",
        f"{RATIONAL} contact_motion: [contacts.n, contacts.d1, contacts.d2] -> "
        "[contacts.n, contacts.d2, contacts.d1]",
    ),
    "certify/test_exact.py::test_grasp_is_decided_by_balls_alone": (
        f"{MINIMISER} Minimiser.zero_coordinates: i == v -> i != v",
    ),
    "certify/test_rational.py::test_step_is_formed_without_rounding": (
        f"{RATIONAL} in_integers: two_to(H.e + e_x) / h -> two_to(H.e + e_x) * h",
    ),
    "certify/test_rounding.py::test_decimal_strings_round_half_to_even": (
        "cli/decimals.py decimal_string: exponent - digits + 1 -> exponent - digits - 1",
    ),
    "certify/test_farkas.py::test_false_proofs_are_refused_with_a_reason": (
        f"{FRICTION} row_constants: cone(name).matrix[:, 0] -> cone(name).matrix[:, 1]",
        f"{FARKAS} farkas_refutation: y_i < 0 -> y_i > 0",
        f"{FARKAS} farkas_refutation: (row * form.b)[0, 0] > 0 -> (row * form.b)[0, 0] >= 0",
    ),
}
"""Tests, and mutants that they notice."""


def test_every_mutant_of_the_sample_is_killed():
    keys = [key for own in SAMPLE.values() for key in own]
    known = {mutant.key: mutant for mutant in all_mutants({key.split()[0] for key in keys})}
    gone = [key for key in keys if key not in known]
    assert not gone, f"no longer mutants of the package, renew them: {gone}"
    tests = {key: (test,) for test, own in SAMPLE.items() for key in own}
    said = dict(outcomes([known[key] for key in keys], lambda mutant: tests[mutant.key], jobs=2))
    assert not [key for key in keys if said[key] == "survived"]


def test_no_file_has_more_survivors_than_reasons():
    given = Counter(key.split()[0] for key in reasons())
    survivors = {file: int(row[-1]) for file, row in tried_files().items()}
    assert [file for file, count in survivors.items() if count > given[file]] == []


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
