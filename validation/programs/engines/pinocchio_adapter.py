"""pinocchio: phenomena by its ADMM solver for contacts, in a loop of ours: it has no simulator.

Semi-implicit Euler, spheres on the floor: v+ = v + h M^-1 f + M^-1 J' lam. The solver finds
impulses lam in Coulomb's cone, without torsion, so that J v+ + gap / h is in the dual cone: with
``ncp`` after De Saxce's correction, which is Coulomb's law, without it of the convex problem.
"""

from typing import Any

import numpy as np
import pinocchio as pin
from door import Unsupported, answer, run


def phenomena(scene: Any, setting: Any) -> Any:
    """A scene of one free body."""
    if len(scene["bodies"]) > 1 or not scene["floor"]:
        raise Unsupported("the loop knows one body on a floor")
    (body,) = scene["bodies"]
    h = setting["h"]
    feet = body["shapes"]
    model = pin.Model()
    model.gravity.linear = np.array(scene["gravity"])
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), body["name"])
    inertia = pin.Inertia(body["mass"], np.zeros(3), np.diag(body["inertia"]))
    model.appendBodyToJoint(joint, inertia, pin.SE3.Identity())
    data = model.createData()
    models = pin.StdVec_ConstraintModel()
    datas = pin.StdVec_ConstraintData()
    for _ in feet:
        at = pin.SE3.Identity()
        contact = pin.PointContactConstraintModel(model, 0, at, joint, at)
        contact.setFriction(scene["mu_v"])
        models.append(pin.ConstraintModel(contact))
        datas.append(models[-1].createData())
    solver = pin.ADMMConstraintSolver()
    settings = pin.ADMMSolverSettings()
    settings.absolute_feasibility_tol = settings.absolute_complementarity_tol = setting["tolerance"]
    settings.relative_feasibility_tol = settings.relative_complementarity_tol = setting["tolerance"]
    settings.max_iterations = setting["iterations"]
    settings.solve_ncp = setting["ncp"]
    result = pin.ADMMSolverResult()
    state = {"q": np.array([*body["xyz"], 0, 0, 0, 1.0]), "v": np.zeros(model.nv)}

    def step(loads: Any) -> None:
        q = state["q"]
        v = state["v"]
        pin.computeJointJacobians(model, data, q)
        R = data.oMi[joint].rotation
        centre = data.oMi[joint].translation
        world = pin.getJointJacobian(model, data, joint, pin.LOCAL_WORLD_ALIGNED)
        rows = []
        gaps = []
        for foot in feet:
            arm = R @ np.array(foot["xyz"]) - [0, 0, foot["radius"]]
            rows.append(world[:3] - pin.skew(arm) @ world[3:])
            gaps.append([0, 0, (centre + arm)[2]])
        J = np.vstack(rows)
        gap = np.concatenate(gaps)
        M = pin.crba(model, data, q)
        M = np.triu(M) + np.triu(M, 1).T
        force = loads[body["name"]]
        tau = world[:3].T @ force[0] + world[3:].T @ force[1] - pin.rnea(model, data, q, v, 0 * v)
        free = v + h * np.linalg.solve(M, tau)
        G = J @ np.linalg.solve(M, J.T)
        g = J @ free + gap / h
        solver.solve(pin.DelassusOperatorDense(G), g, models, datas, settings, result)
        lam = np.array(result.retrieveConstraintImpulses()).ravel() * setting.get("scale", 1.0)
        state["v"] = free + np.linalg.solve(M, J.T @ lam)
        state["q"] = pin.integrate(model, q, h * state["v"])

    return run(scene, h, step, lambda _: state["q"])


if __name__ == "__main__":
    answer(f"pinocchio {pin.__version__}", phenomena)
