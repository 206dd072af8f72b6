"""MuJoCo: distances by mj_geomDistance; rows by efc_J and efc_pos, of contacts that it found.

mj_geomDistance gives two points and no normal: the way between them is divided by its length. The
inputs of the rows are MuJoCo's own contacts, frames and point Jacobians (mj_jac at its one contact
point, for both bodies), so that only the forming of the rows is compared. efc_J's rows are
interleaved and are put in our order.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from door import Unsupported

ORDER = [0, 2, 1, 3, 4, 5]


def geom(name: str, shape: Any) -> str:
    """A shape in MJCF."""
    kind = shape["kind"]
    size = {
        "sphere": lambda: [shape["radius"]],
        "box": lambda: np.array(shape["size"]) / 2,
        "capsule": lambda: [shape["radius"], shape["length"] / 2],
        "cylinder": lambda: [shape["radius"], shape["length"] / 2],
        "ellipsoid": lambda: shape["half_axes"],
    }.get(kind)
    if size is None:
        raise Unsupported(f"{kind} is no shape that it measures")
    return f'<geom name="{name}" type="{kind}" size="{" ".join(repr(float(x)) for x in size())}"/>'


def distance(case: Any) -> Any:
    """Layer 1."""
    bodies = []
    for side in ("alpha", "beta"):
        pose = case[f"pose_{side}"]
        x, y, z, w = np.array(pose["quaternion"]) / np.linalg.norm(pose["quaternion"])
        at = " ".join(repr(float(v)) for v in pose["xyz"])
        quat = " ".join(repr(float(v)) for v in (w, x, y, z))
        bodies.append(f'<body pos="{at}" quat="{quat}">{geom(side, case[side])}</body>')
    text = f"<mujoco><worldbody>{''.join(bodies)}</worldbody></mujoco>"
    try:
        model = mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        raise Unsupported(str(error)) from None
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    ends = np.zeros(6)
    phi = mujoco.mj_geomDistance(model, data, 0, 1, 1e3, ends)
    way = ends[3:] - ends[:3]
    length = np.linalg.norm(way)
    n = np.sign(phi) * way / length if length else np.zeros(3)
    return {"phi": phi, "alpha": ends[:3], "beta": ends[3:], "n": n}


def heap(case: Any) -> Any:
    """Contacts of a heap of bodies as an input of the layer rows, and MuJoCo's rows."""
    model = mujoco.MjModel.from_xml_string(case["mjcf"])
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    efc_J = data.efc_J.reshape(data.nefc, -1)
    contacts, A, b = [], [], []
    for contact in data.contact:
        if contact.efc_address < 0 or contact.dim != 4:
            continue
        n, d1, d2 = contact.frame.reshape(3, 3)
        v, w = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        for number, sign in ((contact.geom2, 1), (contact.geom1, -1)):
            jacp, jacr = np.zeros((3, model.nv)), np.zeros((3, model.nv))
            mujoco.mj_jac(model, data, jacp, jacr, contact.pos, model.geom_bodyid[number])
            v, w = v + sign * jacp, w + sign * jacr
        mu_v, _, mu_omega = contact.friction[:3]
        contacts.append({"phi": contact.dist, "n": n, "d1": d1, "d2": d2, "mu_v": mu_v,
                         "mu_omega": mu_omega, "rows": 6, "J": np.vstack([v, n @ w])})  # fmt: skip
        rows = slice(contact.efc_address, contact.efc_address + 6)
        A.extend(efc_J[rows][ORDER])
        b.extend(-data.efc_pos[rows][ORDER])
    return {"input": {"cone": "pyramid", "contacts": contacts}, "output": {"A": A, "b": b}}
