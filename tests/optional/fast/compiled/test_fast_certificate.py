"""Proofs in fixed point: their bounds hold, each constant is needed, their bits are exact."""

import ctypes
from fractions import Fraction
from functools import cache
from operator import mul

import numpy as np
import pytest

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.rational import exact_form
from tests.helpers import changed, random_step
from tests.optional.fast.compiled.changed_c import changed_sources, library_of
from tests.optional.fast.compiled.test_fast import needs_compiler
from validation.make.confirmed_bits import differing_fields, proof

pytestmark = needs_compiler
MATRICES = 40


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


@cache
def matrices():
    """Regular matrices, sizes 1 to 9, rows of all sizes; inverses, vectors, defects of these."""
    rng = np.random.default_rng(3)
    found = []
    for k in range(MATRICES):
        n = 1 + k % 9
        K = rng.normal(size=(n, n)) * (2.0 ** rng.integers(-20, 21, (n, 1)) if k % 2 else 1.0)
        R = np.ascontiguousarray(np.linalg.inv(K))
        found.append((K, R, rng.normal(size=n), exact_defect(R, K)))
    return found


def exact_product(A, B):
    A, B = ([[Fraction(x) for x in row] for row in M.tolist()] for M in (A, B))
    columns = list(zip(*B, strict=True))
    return [[sum(map(mul, row, column)) for column in columns] for row in A]


def exact_defect(R, K):
    """|I - R K| without rounding."""
    product = exact_product(R, K)
    return [[abs(Fraction(int(i == j)) - x) for j, x in enumerate(row)]
            for i, row in enumerate(product)]  # fmt: skip


def holds(library):
    """Whether the bounds of a library are bounds, on all matrices."""
    for K, R, r, exact in matrices():
        n = len(K)
        G = np.zeros((n, n))
        e = np.zeros(n)
        library.defect(*map(pointer, (R, K, K)), ctypes.c_int64(n), pointer(G), pointer(e))
        if any(Fraction(G[i, j]) < exact[i][j] for i in range(n) for j in range(n)):
            return False
        for bound in (G, np.full((n, n), 0.55 / n)):  # the second shows no contraction by a half
            # With G as the largest that I - R K may be, e = z* - z is at most (I - G)^-1 |R| |r|.
            r_bound = np.abs(R) @ np.abs(r)
            largest = np.linalg.solve(np.eye(n) - bound, r_bound)
            given = pointer(R), pointer(bound), pointer(r)
            shown = library.error_bounds(*given, ctypes.c_int64(n), pointer(e))
            if shown and not (e >= largest * (1 - 1e-9)).all():
                return False
            if shown != (bound is G):
                return False
    return True


def test_the_bounds_of_a_proof_are_bounds(tmp_path):
    assert holds(mutant_library(tmp_path, "", ""))


def test_a_bound_that_is_infinite_shows_no_contraction(tmp_path):
    R, G = np.full((2, 2), 1e300), np.full((2, 2), 0.9)
    r, e = np.full(2, 1e10), np.zeros(2)
    given = pointer(R), pointer(G), pointer(r), ctypes.c_int64(2), pointer(e)
    assert not mutant_library(tmp_path, "", "").error_bounds(*given)


MUTANTS = {
    "no rounding of the sums": ("((double)n * 0x1p-52 + 0x1p-47) * (sizes[j] + one)", "0.0"),
    "no rounding of K and of the difference": ("+ 0x1p-47) * (sizes[j] + one)", ") * 0.0"),
    "a contraction by twice": ("e[i] / 2", "e[i] * 2"),
    "the bound itself": ("e[i] = 2 * e[i]", "e[i] = 0.5 * e[i]"),
    "one residual less": (
        "for (int64_t j = 0; j < n; j++)\n            w +=",
        "for (int64_t j = 1; j < n; j++)\n            w +=",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MUTANTS)
def test_each_constant_of_the_bounds_is_needed(tmp_path, name):
    assert not holds(mutant_library(tmp_path, *MUTANTS[name]))


def mutant_library(folder, text, other):
    """The functions of contraction.c, which call no other file, with one text replaced."""
    changed_sources(folder, "contraction.c", text, other)
    return library_of(folder, "contraction.c")


@pytest.mark.parametrize(("factor", "shown"), [(1.0, True), (2.0**-600, False)])
def test_numbers_that_do_not_fit_are_left_to_balls(factor, shown):
    step = random_step(np.random.default_rng(2))
    J = step.contacts.J.copy()
    J[0, 0, 0] *= factor  # its last bit is then below the grid
    step = step.replace(contacts=changed(step.contacts, J=J))
    truth = form_optimum(exact_form(step))
    assert not isinstance(truth, Farkas)
    found = proof(step, np.array(truth.working_set, dtype=np.int64))
    assert (found is not None) == shown
    if shown:
        assert not differing_fields(found, form_optimum(exact_form(step), list(truth.working_set)))
