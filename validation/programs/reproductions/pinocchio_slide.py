"""A sled on four feet, which does not turn, under the load of a slope of tangent 1, mu = 0.5: how far it rises, over the slip of a step of 1 ms."""

import numpy as np
import pinocchio as pin

J = np.vstack([np.hstack([np.eye(3), -pin.skew(np.array([x, y, -0.02]))]) for x in (-0.1, 0.1) for y in (-0.1, 0.1)])
models = pin.StdVec_ConstraintModel()
datas = pin.StdVec_ConstraintData()
M_inv = np.diag([1 / 0.3] * 3 + [1e3, 1e3, 500])
for _ in range(4):
    (contact := pin.PointContactConstraintModel(pin.Model(), 0, pin.SE3.Identity(), 0, pin.SE3.Identity())).setFriction(0.5)
    models.append(pin.ConstraintModel(contact)) or datas.append(models[-1].createData())
for name, ncp in ("NCP", True), ("without the NCP's correction", False):
    (settings := pin.ADMMSolverSettings()).solve_ncp, v, z, solver, result = ncp, np.zeros(6), 0.0, pin.ADMMConstraintSolver(), pin.ADMMSolverResult()
    for _ in range(500):
        free = v + 0.001 * np.array([2.0810 / 0.3, 0, 0.86198 / 0.3 - 9.81, 0, 0, 0])  # the load of the slope, and gravity
        solver.solve(pin.DelassusOperatorDense(J @ M_inv @ J.T), J @ free + [0, 0, z / 0.001] * 4, models, datas, settings, result)
        v = free + M_inv @ J.T @ np.array(result.retrieveConstraintImpulses()).ravel()
        z += 0.001 * v[2]
    print(f"ADMM in a loop of ours, {name}: {z / (0.001 * v[0]):.3g} of the slip of a step (Coulomb: 0)")
