"""Layer 4: the rows of the contacts, A delta_q >= b."""

import numpy as np


def cone_table(cone, rows):
    """T of each row of a contact, in units of (mu_v, mu_v, mu_omega)."""
    sides = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    spins = [[0, 0, 1], [0, 0, -1]]
    if cone == "frictionless":
        return np.zeros((1, 3))
    if cone == "product":
        both = [[a, b, s if rows == 6 else 0] for s in (1, -1) for a, b, _ in sides]
        return np.array(both if rows == 6 else both[:4], dtype=float)
    if cone != "pyramid":
        K = int(cone.split("-")[1])
        angles = 2 * np.pi * np.arange(K) / K
        sides = [[np.cos(a), np.sin(a), 0] for a in angles]
    return np.array(sides + (spins if rows == 6 else []), dtype=float)


def rows(case):
    """Layer 4."""
    A, b = [], []
    for c in case["contacts"]:
        T = cone_table(case["cone"], c["rows"])
        n = np.array(c["n"])
        J = np.array(c["J"], dtype=float)
        linear = n + c["mu_v"] * T[:, :2] @ np.array([c["d1"], c["d2"]])
        angular = c["mu_omega"] * T[:, 2]
        A.extend(np.column_stack([linear, angular]) @ J)
        b.extend([-c["phi"]] * len(T))
    return {"A": A, "b": b}
