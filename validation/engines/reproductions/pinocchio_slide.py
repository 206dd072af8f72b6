"""A point mass that slides at 1 m/s on a floor: the velocity after a step of 1 ms, mu = 0.5."""

import numpy as np
import pinocchio as pin

model = pin.Model()
model.addJoint(0, pin.JointModelTranslation(), pin.SE3.Identity(), "point")
contact = pin.PointContactConstraintModel(model, 0, pin.SE3.Identity(), 1, pin.SE3.Identity())
contact.setFriction(0.5)
models, datas = pin.StdVec_ConstraintModel(), pin.StdVec_ConstraintData()
models.append(pin.ConstraintModel(contact))
datas.append(models[0].createData())
free, G = np.array([1, 0, -9.81e-3]), pin.DelassusOperatorDense(np.eye(3) / 0.3)
for solver, ncp in (pin.ADMMConstraintSolver(), True), (pin.ADMMConstraintSolver(), False):
    settings, result = pin.ADMMSolverSettings(), pin.ADMMSolverResult()
    settings.solve_ncp = ncp
    solver.solve(G, free, models, datas, settings, result)
    print(ncp, free + np.array(result.retrieveConstraintImpulses()) / 0.3, "m/s (Coulomb: 0 up)")
