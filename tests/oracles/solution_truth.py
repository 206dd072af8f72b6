"""What a solution file claims, decided by fractions from the equations: the judge of forgeries.

H, g, A and b are formed in fractions by the checker for sceptics (``validation/check_solution.py``)
from the file of the step. In a polyhedral cone an exact file admits no change. In the ellipsoid,
which the checker refuses, its rows are formed here; the optimum is that on the rows that a file
names, or the package encloses it to 40 digits.
"""

import json
from fractions import Fraction

import numpy as np
from flint import arb

from quasistatic_ref import StepInfeasible, solve_step
from tests.made import infeasible_text, solution_text, step_text
from tests.oracles.rational_kkt import exact, fractions, on_rows, solution
from validation import check_solution as checker

MAY_CHANGE = {
    "exact": (),
    "exact in the ellipsoid": ("lam", "lam_extra", "wrench", "gap"),
    "enclosure": ("delta_q", "lam", "lam_extra", "wrench", "error_bound", "gap"),
    "infeasible": ("farkas",),
}
"""What a file of each kind does not fix to the last bit."""
ROUNDING = 1 + Fraction(1, 10**30)
"""The optimum in the ellipsoid is known to 40 digits here."""


def solution_file(step, solver=None, certify="full"):
    """The file of a step's solution, or of the proof that it has none."""
    try:
        return solution_text(solve_step(step, solver, certify=certify))
    except StepInfeasible as proof:
        return infeasible_text(step, proof.farkas.exact)


def record_of(step):
    """What the checker reads of a step's file."""
    return checker.step_read(json.loads(step_text(step)))


def refuted(step, text):
    """The claims of a solution file that the checker refutes."""
    claims = checker.verdicts(record_of(step), checker.solution_read(json.loads(text)))
    return [claim for claim, holds in claims if not holds]


def program(step):
    """H, g, A and b, without rounding."""
    if step.cone != "ellipsoid":
        H, g, A, b, _ = checker.problem(record_of(step))
        n_v = len(g)
        shapes = (n_v, n_v), n_v, (len(b), n_v), len(b)
        both = zip((H, g, A, b), shapes, strict=True)
        return tuple(np.array(part, dtype=object).reshape(shape) for part, shape in both)
    H, g, _, _ = program(step.replace(cone="frictionless"))
    c, extra = step.contacts, step.extra
    J = exact(c.J)
    rows = exact(np.stack([c.n, c.d1, c.d2], axis=1)) @ J[:, :3]
    A = np.concatenate([rows, J[:, 3:]], axis=1).reshape(-1, step.n_v)
    b = np.append(np.kron(-c.phi, [1, 0, 0, 0]), extra.b)
    return H, g, np.concatenate([A, exact(extra.A)]), exact(b)


def weights(step):
    """Of each contact what its rows take of d1, d2, n and spin, with the friction coefficients."""
    if step.cone == "ellipsoid":
        return [np.eye(4, dtype=int)[[2, 0, 1, 3]]] * step.contacts.n_c
    return [np.array(rows, dtype=object) for rows in checker.problem(record_of(step))[4]]


def wrenches(step, lam):
    """(f_d1, f_d2, f_n, tau_n) of each contact from its multipliers, rounded once."""
    both = zip(weights(step), lam, strict=True)
    forces = [exact(impulses) @ rows / Fraction(step.h) for rows, impulses in both]
    return [[*map(checker.rounded, parts)] for parts in forces]


def truth_of(step, good):
    """Whether a forged record of a step still says the truth, given a record that does."""
    kind = good["certificate"]["kind"] if good["status"] == "optimal" else "infeasible"
    if step.cone == "ellipsoid" and kind == "exact":
        kind += " in the ellipsoid"
    free = MAY_CHANGE.get(kind, ())
    in_ellipsoid = near_optimum(step, good["certificate"]) if "lam" in free else None

    def fixed(record):
        """A record without what may change."""
        kept = {k: v for k, v in record.items() if k not in free}
        if "certificate" in kept:
            kept["certificate"] = {k: v for k, v in kept["certificate"].items() if k not in free}
        return kept

    def holds(forged):
        try:
            if fixed(forged) != fixed(good):
                return False
            if in_ellipsoid is None:
                return kind != "infeasible" or not refuted(step, json.dumps(forged))
            return forged["wrench"] == wrenches(step, forged["lam"]) and in_ellipsoid(forged)
        except (ArithmeticError, LookupError, TypeError, ValueError, AttributeError):
            return False

    return holds


def near_optimum(step, true):
    """Whether claims of a record hold in the ellipsoid, where those of a certificate are true.

    Impulses are in their cones, and the gap f(x*) - d(lam) [N m s] and the error of delta_q are
    within what is claimed.
    """
    H, g, _, _ = of = program(step)
    if true["kind"] == "enclosure":
        from quasistatic_ref.optional.ellipsoid.enclosure import checked_pair, point

        best = exact(fractions(point(checked_pair(step, arb(2) ** -280, 1536))))
    else:  # every loaded contact sticks
        best, _ = on_rows(of, [4 * j + i for j, i in true["active"]])
    free = g @ solution(H, g)
    rounding = Fraction(1e-9) * (free + best @ H @ best) / 2 * ROUNDING

    def holds(record):
        claims = record["certificate"]
        lam = exact([v for part in record["lam"] for v in part] + record["lam_extra"])
        if not gap(of, best, lam) <= Fraction(claims["gap"]) * ROUNDING <= rounding:
            return False
        if true["kind"] == "enclosure":
            bound = Fraction(claims["error_bound"])
            off = exact(record["delta_q"]) - best
            if off @ H @ off > bound**2 * ROUNDING * free or bound > Fraction(1e-13):
                return False
        return inside(step, lam)

    return holds


def gap(of, x, lam):
    """f(x) - d(lam) = 1/2 ||H x - g - A'lam||^2 in the norm of H^-1, plus lam'(A x - b)."""
    H, g, A, b = of
    left = H @ x - g - lam @ A
    return left @ solution(H, left) / 2 + lam @ (A @ x - b)


def inside(step, lam):
    """Whether impulses (n, d1, d2, spin) are inside of their cones."""
    own = 4 * step.contacts.n_c
    for mu, (f_n, *f) in zip(exact(step.contacts.mu), lam[:own].reshape(-1, 4), strict=True):
        if any(v and not m for m, v in zip(mu, f, strict=True)):
            return False
        if f_n < 0 or f_n**2 < sum((v / m) ** 2 for m, v in zip(mu, f, strict=True) if m):
            return False
    return all(v >= 0 for v in lam[own:])
