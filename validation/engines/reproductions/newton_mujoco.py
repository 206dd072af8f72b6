"""A ball that cannot roll, by SolverMuJoCo, under 0.9 and 1.6 of its limit along x, and 0.99 in torsion."""

import newton

newton.solvers.SolverMuJoCo.register_custom_attributes(builder := newton.ModelBuilder())
builder.add_mjcf("""<mujoco><default><geom friction=".5 .01 0" condim="4" size=".05"/></default><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 .05"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 0 1"/><geom/>
  <inertial pos="0 0 0" mass=".3" diaginertia="3e-4 3e-4 3e-4"/></body></worldbody></mujoco>""")
for f_x, t_z in (0.9 * 0.5 * 2.943, 0), (1.6 * 0.5 * 2.943, 0), (0, 0.99 * 0.01 * 2.943):
    solver = newton.solvers.SolverMuJoCo(model := builder.finalize(device="cpu"), cone="elliptic")
    old, new, contacts = model.state(), model.state(), model.contacts()
    for _ in range(500):
        old.body_f.assign([[f_x, 0, 0, 0, 0, t_z]])
        solver.step(old, new, model.control(), contacts, 0.001)
        old, new = new, old
    v, z = old.body_qd.numpy()[0], old.body_q.numpy()[0, 2]
    print(f"{f_x:.3f} N, {t_z:.4f} N m: {v[0]:.3g} m/s, {v[5]:.3g} rad/s, {1000 * (z - 0.05):.3g} mm above the floor")
