"""How large the terms are that make H and g: where they cancel, their rounding is what is left."""

import numpy as np

from quasistatic_ref.lab.program.mechanism import kinematics, slices
from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.lab.vectors.expected import Json


def terms(case: Json) -> tuple[float, float]:
    """The largest sums of sizes of what an entry of H and one of g is made of, in their units.

    A lever is a difference of world coordinates, that of two poses one of coordinates, cosines and
    sines; that of two angles or lengths has no digits to lose.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``.
    """
    _, n_a, n_v = slices(case["mechanism"])
    at = kinematics(case["mechanism"], np.array(case["q"], dtype=np.float64))
    size = np.zeros(n_v)
    inertia = np.zeros(n_v)
    free = np.arange(n_v) >= n_a
    for body in case["mechanism"]["bodies"]:
        R, t, J = at[body["name"]]
        centre = R @ np.array(body.get("com", np.zeros(3))) + t
        mass = body.get("mass", 0.0)
        arm = float(np.linalg.norm(centre - t))
        loads = [w for w in case.get("wrenches", []) if w["body"] == body["name"]]
        force, torque = (
            sum(float(np.linalg.norm(w[name])) for w in loads) for name in ("force", "torque")
        )
        weight = mass * float(np.linalg.norm(case["gravity"]))
        velocity = np.linalg.norm(J[:3], axis=0)
        turn = np.linalg.norm(J[3:], axis=0)
        reach = velocity + turn * (np.abs(centre).max() + np.abs(t).max())
        inertia += mass * (velocity + turn * arm) * reach * free
        size += (force + weight * free) * reach + torque * turn
    for body, q, v in places(case["mechanism"]):
        if q.stop > q.start and v.stop <= n_a:
            old = np.array(case["q"][q])
            new = np.array(case["q_bar_a"][q])
            one = body["joint"] in ("revolute", "prismatic")
            way = np.abs(new - old).max() if one else 1.0 + 2 * np.abs([old, new]).max()
            size[:n_a] += np.abs(np.array(case["K_q"])[:, v]).sum(axis=1) * float(way)
    h = case["h"]
    return float(inertia.max(initial=0.0) / h), float(h * size.max(initial=0.0))
