"""Layer 4: the rows of the contacts, A delta_q >= b."""

import numpy as np


def cone_table(cone, rows):
    """T of each row of a contact, in units of (mu_v, mu_v, mu_omega).

    Raises
    ------
    ValueError
        If the cone is another one.
    """
    sides = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    spins = [[0, 0, 1], [0, 0, -1]]
    if cone == "frictionless":
        return np.zeros((1, 3), dtype=int)
    if cone == "product":
        both = [[a, b, s if rows == 6 else 0] for s in (1, -1) for a, b, _ in sides]
        return np.array(both if rows == 6 else both[:4])
    if cone.startswith("facets-"):
        K = int(cone.removeprefix("facets-"))
        angles = [2 * np.pi * k / K for k in range(K)]
        sides = [[np.cos(angle), np.sin(angle), 0] for angle in angles]
    elif cone != "pyramid":
        raise ValueError(f"the cone {cone} is none that this program knows")
    return np.array(sides + (spins if rows == 6 else []))


def contact_rows(c, cone):
    """The rows of one contact."""
    T = cone_table(cone, c["rows"])
    J = np.array(c["J"])
    linear = np.array(c["n"]) + c["mu_v"] * T[:, :2] @ np.array([c["d1"], c["d2"]])
    angular = c["mu_omega"] * T[:, 2]
    return np.column_stack([linear, angular]) @ J


def rows(case):
    """Layer 4: A and b of the contacts of a case."""
    A = []
    b = []
    for c in case["contacts"]:
        block = contact_rows(c, case["cone"])
        A.extend(block)
        b.extend([-c["phi"]] * len(block))
    return {"A": A, "b": b}
