"""A ball under 0.99 of the torque about the normal that friction holds, by XPBD: its rate."""

import newton

builder = newton.ModelBuilder(gravity=(0, 0, -9.81))
builder.default_shape_cfg = builder.ShapeConfig(density=573, mu=0.5, mu_torsional=0.01)
builder.add_ground_plane()
builder.add_shape_sphere(builder.add_body(xform=((0, 0, 0.05), (0, 0, 0, 1))), radius=0.05)
model = builder.finalize(device="cpu")
solver = newton.solvers.SolverXPBD(model)
old, new, contacts = model.state(), model.state(), model.contacts()
for k in range(1000):
    torque = 0.99 * 0.01 * 9.81 * model.body_mass.numpy()[0] * (k >= 500)
    old.body_f.assign([[0, 0, 0, 0, 0, torque]])
    model.collide(old, contacts)
    solver.step(old, new, model.control(), contacts, 0.001)
    old, new = new, old
print(f"{old.body_qd.numpy()[0, 5]:.3g} rad/s (Coulomb: 0)")
