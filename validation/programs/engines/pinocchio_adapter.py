"""pinocchio: layers jacobian and integrate; phenomena by its ADMM solver (pinocchio_admm.py)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
from door import Unsupported, answer, rotation
from pinocchio_admm import phenomena

NAME = f"pinocchio {pin.__version__}"
UNIT = {"floating": 3, "planar": 2, "continuous": 0}
JOINTS = {
    "floating": lambda _: pin.JointModelFreeFlyer(),
    "planar": lambda _: pin.JointModelPlanar(),
    "revolute": pin.JointModelRevoluteUnaligned,
    "continuous": lambda _: pin.JointModelRUBZ(),
    "prismatic": pin.JointModelPrismaticUnaligned,
}


class Mechanism:
    """A pinocchio model of a mechanism, and the two orders of its coordinates."""

    def __init__(self, mechanism: Any) -> None:
        if any("mimic" in body for body in mechanism["bodies"]):
            raise Unsupported("mimic joints are left to URDF")
        self.model, self.frames = pin.Model(), {None: (0, pin.SE3.Identity())}
        joints = {}
        for body in mechanism["bodies"]:
            parent, inside = self.frames[body["parent"]]
            pose = body["placement"]
            placement = inside * pin.SE3(rotation(pose["quaternion"]), np.array(pose["xyz"]))
            if body["joint"] == "fixed":
                self.frames[body["name"]] = parent, placement
                continue
            turned, axis = pin.SE3.Identity(), np.array(body.get("axis", [0, 0, 1.0]), dtype=float)
            axis /= np.linalg.norm(axis)
            if body["joint"] == "continuous":  # its axis cannot be given: z is turned onto it
                turned.rotation = pin.Quaternion.FromTwoVectors(
                    np.array([0, 0, 1.0]), axis
                ).matrix()
            model = JOINTS[body["joint"]](axis)
            joint = self.model.addJoint(parent, model, placement * turned, body["name"])
            joints[body["name"]] = joint
            self.frames[body["name"]] = joint, turned.inverse()
        ordered = sorted(
            (b for b in mechanism["bodies"] if b["name"] in joints), key=lambda b: not b["actuated"]
        )
        self.q, self.v, self.units = [], [], []
        for body in ordered:
            joint = self.model.joints[joints[body["name"]]]
            self.q += range(joint.idx_q, joint.idx_q + joint.nq)
            self.v += range(joint.idx_v, joint.idx_v + joint.nv)
            if body["joint"] in UNIT:
                self.units.append(slice(joint.idx_q + UNIT[body["joint"]], joint.idx_q + joint.nq))

    def model_q(self, q: Any) -> np.ndarray:
        """Pinocchio's q; it takes quaternions and (cos, sin) as they are, so at length one."""
        found = np.zeros(self.model.nq)
        found[self.q] = q
        for part in self.units:
            found[part] /= np.linalg.norm(found[part])
        return found


def jacobian(case: Any) -> Any:
    """Layer 3."""
    mechanism = Mechanism(case["mechanism"])
    model, data = mechanism.model, mechanism.model.createData()
    pin.computeJointJacobians(model, data, mechanism.model_q(case["q"]))

    def motion(body: Any, point: Any) -> tuple[Any, Any]:
        joint, _ = mechanism.frames[body]
        if joint == 0:
            return np.zeros((3, model.nv)), np.zeros((3, model.nv))
        J = pin.getJointJacobian(model, data, joint, pin.LOCAL_WORLD_ALIGNED).reshape(6, -1)
        return J[:3] - pin.skew(np.array(point) - data.oMi[joint].translation) @ J[3:], J[3:]

    found = []
    for contact in case["contacts"]:
        v_beta, w_beta = motion(contact["beta_body"], contact["beta"])
        v_alpha, w_alpha = motion(contact["alpha_body"], contact["alpha"])
        spin = np.array(contact["n"]) @ (w_beta - w_alpha)
        found.append(np.vstack([v_beta - v_alpha, spin])[:, mechanism.v])
    return {"J": found}


def integrate(case: Any) -> Any:
    """Layer 7."""
    mechanism = Mechanism(case["mechanism"])
    delta_q = np.zeros(mechanism.model.nv)
    delta_q[mechanism.v] = case["delta_q"]
    q = mechanism.model_q(case["q"])
    return {"q": pin.integrate(mechanism.model, q, delta_q)[mechanism.q]}


if __name__ == "__main__":
    answer(NAME, {"jacobian": jacobian, "integrate": integrate, "phenomena": phenomena})
