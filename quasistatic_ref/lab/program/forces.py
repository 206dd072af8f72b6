"""The forces of single contacts: each gives way a little, and of many optimal lam one is left."""

import numpy as np

from .optimum import optimum
from .rows import cone_table

COMPLIANCE = 1e-9
"""c [m/N] of a pair that has no ``compliance``."""


def compliances(contacts):
    """The compliance c of each contact [m/N]."""
    return [contact.get("compliance", COMPLIANCE) for contact in contacts]


def compliant_program(H, g, A, b, tables, h, c):
    """H, g, A, b of a step in which four lengths s of each contact are added to gap, slips, spin.

    Its unknowns are delta_q and then s, which costs h |s|^2 / (2 c), with the c of each contact.
    The t of a contact's rows are in its table.
    """
    n = len(g)
    lengths = 4 * len(tables)
    C = np.zeros((len(b), lengths))
    row = 0
    for j, T in enumerate(tables):
        C[row : row + len(T), 4 * j : 4 * j + 4] = np.column_stack([np.ones(len(T)), T])
        row += len(T)
    aside = np.zeros((n, lengths))
    stiffness = np.diag(np.repeat([h / c_j for c_j in c], 4))
    return (
        np.block([[H, aside], [aside.T, stiffness]]),
        np.append(g, np.zeros(lengths)),
        np.hstack([A, C]),
        b,
    )


def forces_of(s, c, contacts):
    """f_d1, f_d2, f_n, tau_n of each contact, of the lengths s and the compliances c."""
    wrenches = []
    for contact, c_j, s_j in zip(contacts, c, s.reshape(-1, 4), strict=True):
        f_n, f_1, f_2, f_3 = s_j / c_j
        mu_v = contact["mu_v"]
        wrenches.append([mu_v * f_1, mu_v * f_2, f_n, contact["mu_omega"] * f_3])
    return wrenches


def forces(H, g, A, b, contacts, cone, h, method=optimum):
    """The forces of the contacts of a step that has a solution."""
    tables = [cone_table(cone, contact["rows"]) for contact in contacts]
    c = compliances(contacts)
    x, _ = method(*compliant_program(H, g, A, b, tables, h, c))
    return forces_of(x[len(g) :], c, contacts)
