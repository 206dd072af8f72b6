"""How large the terms are that make H and g: where they cancel, their rounding is what is left.

The committed steps have few that do; cases at random have all kinds.
"""

import numpy as np

from quasistatic_ref.lab.vectors.exact.algebra import moved
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, MechanismBody, poses
from quasistatic_ref.lab.vectors.exact.precision import numbers, rounded
from quasistatic_ref.lab.vectors.expected import Json


def terms(tree: Mechanism, case: Json) -> tuple[float, float]:
    """The largest sums of sizes of what an entry of H and one of g is made of, in their units.

    A lever is a difference of world coordinates, a difference of turns one of cosines and sines.

    Parameters
    ----------
    tree : Mechanism
    case : dict
        Input of the layer ``step``.
    """
    found = rounded(lambda: _moves(tree, case))[0]
    size, inertia = np.zeros(tree.n_v), np.zeros(tree.n_v)
    for body, (centre, origin, columns) in zip(tree.bodies, found, strict=True):
        weight = body.table.get("mass", 0.0) * float(np.linalg.norm(case["gravity"]))
        loads = [w for w in case.get("wrenches", []) if w["body"] == body.name]
        force = sum(float(np.linalg.norm(w["force"])) for w in loads)
        torque = sum(float(np.linalg.norm(w["torque"])) for w in loads)
        lever = np.abs(centre).max() + np.abs(origin).max()
        mass, arm = body.table.get("mass", 0.0), float(np.linalg.norm(np.subtract(centre, origin)))
        for v, velocity, turn in columns:
            own = np.linalg.norm(velocity) + np.linalg.norm(turn) * arm
            reach = np.linalg.norm(velocity) + np.linalg.norm(turn) * lever
            inertia[v] += mass * own * reach * (v >= tree.n_a)
            size[v] += (force + weight * (v >= tree.n_a)) * reach + torque * np.linalg.norm(turn)
    for body in tree.bodies:
        if body.actuated and body.mimic is None and body.kind != "fixed":
            away = _turned(body, case)
            for i in range(tree.n_a):
                stiff = [abs(x) for x in case["K_q"][i][body.v]]
                size[i] += sum(stiff) * away
    h = case["h"]
    return float(inertia.max(initial=0.0) / h), float(h * size.max(initial=0.0))


def _moves(tree: Mechanism, case: Json) -> Json:
    """Of each body its centre of mass, its origin, and its columns: v, velocity, turn."""
    at = poses(tree, case["q"])
    found = []
    for k, body in enumerate(tree.bodies):
        centre = moved(at.R[k], at.t[k], numbers(body.table.get("com", [0.0, 0.0, 0.0])))
        columns = [[v, nu, w] for v, (nu, w) in at.columns[k].items()]
        found.append([centre, at.t[k], columns])
    return found


def _turned(body: MechanismBody, case: Json) -> float:
    """Sizes of what the difference of a joint's entries is made of [m, rad]."""
    values = [*case["q"][body.q], *case["q_bar_a"][body.q]]
    return 1.0 + 2 * float(np.abs(values).max())
