"""Layer 6: multipliers to contact wrenches, and to the net wrench of each body.

On beta's body the force acts at beta, on alpha's body its reaction at alpha; the torque about n
is free of a point. lam is an impulse: forces are divided by h.
"""

import numpy as np

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's answer, its forces from :mod:`quasistatic_ref.step.friction`."""
    from quasistatic_ref.lab.vectors.layers.rows import contacts_of
    from quasistatic_ref.step.friction import contact_wrenches

    entries = case_input["contacts"]
    if not entries:
        return {"wrench": [], "net": {body: [0.0] * 6 for body in case_input["bodies"]}}
    still = {"phi": 0.0, "J": [[0.0]] * 4}
    contacts = contacts_of([{**still, **entry} for entry in entries])
    lam = np.concatenate([entry["lam"] for entry in entries])
    wrench = contact_wrenches(contacts, lam, case_input["h"], case_input["cone"])
    force = wrench[:, :1] * contacts.d1 + wrench[:, 1:2] * contacts.d2 + wrench[:, 2:3] * contacts.n
    spin = wrench[:, 3:] * contacts.n
    net = {}
    for body, entry in case_input["bodies"].items():
        net[body] = np.zeros(6)
        for side, sign in (("beta", 1.0), ("alpha", -1.0)):
            on = np.array([e[f"{side}_body"] == body for e in entries])
            arm = np.array([e[side] for e in entries]) - entry["point"]
            torque = np.cross(arm, force) + spin
            net[body] += sign * np.concatenate([force[on].sum(axis=0), torque[on].sum(axis=0)])
    return {"wrench": wrench.tolist(), "net": {body: v.tolist() for body, v in net.items()}}
