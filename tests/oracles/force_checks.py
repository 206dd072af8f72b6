"""Contact forces by compliance: one answer, whatever should not matter.

On a step (random and degenerate: duplicated contacts, penetration, coefficients of 0, masses 1e9
apart; one polyhedral cone after the other):

- backends, plain and fast, and none, cold, and contacts in another order give equal bits;
- so does the definition, in which what each contact gives way by is solved for, too;
- so do fractions: the plain program's rows around those of the step, by Lemke's method (the
  pyramid).
"""

from fractions import Fraction

import numpy as np

from quasistatic_ref import QuasistaticError, contact_forces, solve_step
from quasistatic_ref.lab.program.forces import compliant_program, forces_of
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.optional.forces.forces import WRENCH, defined_optimum
from tests.made import repeated
from tests.oracles.lemke import optimum
from tests.oracles.random_steps import drawn
from tests.oracles.rational_kkt import exact
from tests.oracles.solution_truth import program
from validation.check_solution import rounded

BACKENDS = ("clarabel", "daqp")
CONES = ("pyramid", "product", "facets-6", "frictionless")
LOST = 1e-6
UNITS = (1.0, 1e-3, 1e3)
"""[m]"""


def differences(step, oracle):
    """Of each check 1 if it fails and 0 if it holds; a check that was not made is not there."""
    first = solve_step(step, "none")
    forces = first.forces
    c = first.compliant.compliance
    k = step.contacts
    bits = forces.tobytes()
    order = np.random.default_rng(0).permutation(k.n_c)
    moved = contact_forces(step.replace(contacts=repeated(k, order))).wrench
    others = [solve_step(step, name).forces.tobytes() for name in BACKENDS]
    held = {
        "backends": set(others) == {bits},
        "cold": contact_forces(step).wrench.tobytes() == bits,
        "permuted": moved.tobytes() == forces[order].tobytes(),
    }
    if len(set(c.tolist())) == 1:
        held["definition"] = defined_optimum(step, c[0])[0][:, WRENCH].tobytes() == bits
        if oracle and step.cone == "pyramid" and not step.extra.names:
            held["independent"] = independent_forces(step, c[0]).tobytes() == bits
    return {name: int(not holds) for name, holds in held.items()}


def independent_forces(step, compliance):
    """(f_d1, f_d2, f_n, tau_n) of each contact [N, N m], each rounded once.

    In the step with compliance c [m/N], four lengths s of each contact are added to its gap, slips
    and spin, and cost h |s|^2 / (2 c).
    """
    contacts = step.contacts
    tables = [cone_table(step.cone, rows) for rows in contacts.rows]
    c = [Fraction(compliance)] * contacts.n_c
    softened = compliant_program(*program(step), tables, Fraction(step.h), c)
    H, g, A, b = map(exact, softened)
    x, _ = optimum(H, -g, -A, -b)
    mu = zip(exact(contacts.mu_v), exact(contacts.mu_omega), strict=True)
    entries = [{"mu_v": mu_v, "mu_omega": mu_omega} for mu_v, mu_omega in mu]
    found = forces_of(x[step.n_v :], c, entries)
    return np.array([[*map(rounded, parts)] for parts in found])


def random_steps(count):
    """The first random steps that have a solution."""
    seed = found = 0
    while found < count:
        step = drawn(seed).replace(cone=CONES[seed % len(CONES)])
        seed += 1
        try:
            solve_step(step, "none")
        except QuasistaticError:
            continue
        found += 1
        yield f"random {seed - 1}", step
