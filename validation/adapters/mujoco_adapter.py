"""MuJoCo's efc_J and efc_pos: layer rows, on contacts that MuJoCo found itself.

The inputs are MuJoCo's own contacts, frames and point Jacobians (mj_jac at its one contact point,
for both bodies), so that only the forming of the rows is compared; what is expected of them is
computed by the layer, without rounding. efc_J's rows are interleaved and are put in our order.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from common import plain

from quasistatic_ref.lab.validate.engines.mujoco_scenes import heap
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.check.report import LayerReport
from quasistatic_ref.lab.vectors.files import Case
from quasistatic_ref.lab.vectors.layers import layer

NAME = f"mujoco {mujoco.__version__}"
ORDER = [0, 2, 1, 3, 4, 5]
SCENES = 12


def scene_case(seed: int) -> tuple[Case, Any]:
    """A heap of bodies as a case of the layer rows, and MuJoCo's rows."""
    model = mujoco.MjModel.from_xml_string(heap(seed).mjcf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    efc_J = data.efc_J.reshape(data.nefc, -1)
    contacts, A, b = [], [], []
    for contact in data.contact:
        if contact.efc_address < 0 or contact.dim != 4:
            continue
        n, d1, d2 = contact.frame.reshape(3, 3)
        v, w = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        for geom, sign in ((contact.geom2, 1), (contact.geom1, -1)):
            jacp, jacr = np.zeros((3, model.nv)), np.zeros((3, model.nv))
            body = model.geom_bodyid[geom]
            mujoco.mj_jac(model, data, jacp, jacr, contact.pos, body)
            v, w = v + sign * jacp, w + sign * jacr
        mu_v, _, mu_omega = contact.friction[:3]
        contacts.append({"phi": contact.dist, "n": n, "d1": d1, "d2": d2, "mu_v": mu_v,
                         "mu_omega": mu_omega, "rows": 6, "J": np.vstack([v, n @ w])})  # fmt: skip
        rows = slice(contact.efc_address, contact.efc_address + 6)
        A.extend(efc_J[rows][ORDER])
        b.extend(-data.efc_pos[rows][ORDER])
    inputs = plain({"cone": "pyramid", "contacts": contacts})
    case = Case(f"rows/mujoco_heap/{seed}", "contacts of a heap, as MuJoCo finds them", inputs)
    return case, plain({"A": A, "b": b})


def report() -> tuple[LayerReport, dict[str, str]]:
    """MuJoCo's rows of twelve heaps."""
    pairs = [scene_case(seed) for seed in range(SCENES)]
    cases = [case for case, _ in pairs]
    expected = {
        case.id: {"id": case.id, **layer("rows").expected(case.input).json()} for case in cases
    }
    outputs = {case.id: output for case, output in pairs}
    return layer_report("rows", cases, expected, Answers(outputs, NAME)), {}
