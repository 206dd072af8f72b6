"""Layer 6: the wrenches of the contacts, and what they come to on each body."""

import numpy as np

from .rows import cone_table


def contact_wrench(c, cone, h):
    """f_d1, f_d2, f_n, tau_n of one contact, from its multipliers."""
    lam = np.array(c["lam"]) / h
    if cone == "ellipsoid":
        f_n, f1, f2, tau = lam
    else:
        mu = np.array([c["mu_v"], c["mu_v"], c["mu_omega"]])
        f1, f2, tau = mu * (lam @ cone_table(cone, c["rows"]))
        f_n = lam.sum()
    return [f1, f2, f_n, tau]


def wrench(case):
    """Layer 6: contact wrenches, and each body's wrench, from the multipliers of a case."""
    wrenches = []
    net = {name: np.zeros(6, dtype=int) for name in case["bodies"]}
    for c in case["contacts"]:
        f1, f2, f_n, tau = contact_wrench(c, case["cone"], case["h"])
        wrenches.append([f1, f2, f_n, tau])
        n = np.array(c["n"])
        force = f1 * np.array(c["d1"]) + f2 * np.array(c["d2"]) + f_n * n
        for side, sign in (("beta", 1), ("alpha", -1)):
            body = c[f"{side}_body"]
            if body in net:
                arm = np.array(c[side]) - np.array(case["bodies"][body]["point"])
                torque = np.cross(arm, force) + tau * n
                net[body] = net[body] + sign * np.concatenate([force, torque])
    return {"wrench": wrenches, "net": net}
