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

from quasistatic_ref.optional.ellipsoid.enclosure import checked_pair, point
from tests.made import step_text
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


def record_of(step):
    """What the checker reads of a step's file."""
    return checker.step_read(json.loads(step_text(step)))


def problem(record):
    """H, g, A and b of what the checker reads, as arrays of fractions."""
    H, g, A, b, _ = checker.problem(record)
    n_v = len(g)
    shapes = (n_v, n_v), n_v, (len(b), n_v), len(b)
    both = zip((H, g, A, b), shapes, strict=True)
    return tuple(np.array(part, dtype=object).reshape(shape) for part, shape in both)


def program(step):
    """H, g, A and b, without rounding."""
    if step.cone != "ellipsoid":
        return problem(record_of(step))
    H, g, A, b = problem(record_of(step.replace(cone="frictionless")))
    c = step.contacts
    rows = [A[c.n_c :]]
    for j in reversed(range(c.n_c)):
        J = exact(c.J[j])
        rows[:0] = [exact([c.n[j], c.d1[j], c.d2[j]]) @ J[:3], J[3:]]
    gaps = np.insert(np.zeros((c.n_c, 3), dtype=int).astype(object), 0, b[: c.n_c], axis=1)
    return H, g, np.vstack(rows), np.append(gaps, b[c.n_c :])


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
    known = ("exact in the ellipsoid", "enclosure")
    judged = Judge(step, good) if kind in known else None

    def holds(forged):
        try:
            if _fixed_fields(forged, kind) != _fixed_fields(good, kind):
                return False
            return _holds(forged)
        except (ArithmeticError, LookupError, TypeError, ValueError, AttributeError):
            return False

    def _holds(forged):
        if kind == "infeasible":
            return proof(step, forged["farkas"])
        if judged is None or forged["wrench"] != wrenches(step, forged["lam"]):
            return judged is None
        claims = forged["certificate"]
        bound = Fraction(claims.get("error_bound", 0))
        near = judged.off(forged) <= bound**2 * ROUNDING and bound <= Fraction(1e-13)
        held = judged.gap(forged) <= Fraction(claims["gap"]) * ROUNDING <= judged.rounding
        return (near or kind != "enclosure") and held and _inside(step, judged.lam(forged))

    return holds


class Judge:
    """The optimum of a step in the ellipsoid, and how far answers are from it.

    Parameters
    ----------
    step : StepData
    good : object
        A solution file of it that tells the truth.
    """

    def __init__(self, step, good):
        self.program = program(step)
        H, g, _, _ = self.program
        self.free = g @ solution(H, g)
        self.x = self._optimum(step, good["certificate"])
        taken = self.x @ H @ self.x
        self.rounding = Fraction(1e-9) * (self.free + taken) / 2 * ROUNDING

    def _optimum(self, step, claims):
        if claims["kind"] == "enclosure":
            found = checked_pair(step, arb(2) ** -280, 1536)
            assert found is not None
            return exact(fractions(point(found)))
        working = [4 * j + i for j, i in claims["active"]]  # where every loaded contact sticks
        return on_rows(self.program, working)[0]

    def lam(self, record):
        """All multipliers of a record, the user's own rows last."""
        return exact([v for part in record["lam"] for v in part] + record["lam_extra"])

    def off(self, record):
        """The square of the error of delta_q."""
        away = exact(record["delta_q"]) - self.x
        return away @ self.program[0] @ away / self.free

    def gap(self, record):
        """f(x*) - d(lam) [N m s]."""
        return gap(self.program, self.x, self.lam(record))


def gap(of, x, lam):
    """f(x) - d(lam) = 1/2 ||H x - g - A'lam||^2 in the norm of H^-1, plus lam'(A x - b)."""
    H, g, A, b = of
    left = H @ x - g - lam @ A
    return left @ solution(H, left) / 2 + lam @ (A @ x - b)


def proof(step, y):
    """Whether y, fractions as text, proves that a step has no solution."""
    _, _, A, b, _ = checker.problem(record_of(step))
    return checker.infeasible(A, b, list(y))


def _fixed_fields(record, kind):
    """A record without what may change."""
    free = MAY_CHANGE.get(kind, ())
    kept = {k: v for k, v in record.items() if k not in free}
    if "certificate" in kept:
        kept["certificate"] = {k: v for k, v in kept["certificate"].items() if k not in free}
    return kept


def _inside(step, lam):
    """Whether impulses (n, d1, d2, spin) are inside of their cones."""
    for j, mu in enumerate(exact(step.contacts.mu)):
        f_n, *f = lam[4 * j : 4 * j + 4]
        if any(v and not m for m, v in zip(mu, f, strict=True)):
            return False
        if f_n < 0 or f_n**2 < sum((v / m) ** 2 for m, v in zip(mu, f, strict=True) if m):
            return False
    return all(v >= 0 for v in lam[4 * step.contacts.n_c :])
