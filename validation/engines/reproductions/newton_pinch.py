"""Two fingers press a bar with 15 N, 30 mm beside its centre of mass, by XPBD: twice its limit."""

import newton

builder = newton.ModelBuilder()
builder.add_mjcf("""<mujoco><option gravity="0 0 0"/><default><geom friction=".6 .005 0" size=".02"/></default><worldbody>
  <geom pos="-.05 .03 0"/><body><freejoint/><inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/><geom type="box" size=".03 .1 .02"/>
  </body><body pos=".05 .03 0"><joint type="slide" axis="1 0 0"/><geom density="3000"/></body></worldbody></mujoco>""")
for iterations in 2, 20:
    solver = newton.solvers.SolverXPBD(model := builder.finalize(device="cpu"), iterations=iterations)
    old, new, contacts = model.state(), model.state(), model.contacts()
    for k in range(700):
        old.body_f.assign([[0, 0, -0.2 * 9.81 * (k >= 500), 0, 0, 0], [-15, 0, 0, 0, 0, 0]])
        model.collide(old, contacts)
        solver.step(old, new, model.control(), contacts, 0.001)
        old, new = new, old
    print(f"iterations {iterations}: {2 * old.body_q.numpy()[0, 3]:.3g} rad in 0.2 s (Coulomb: 0)")
