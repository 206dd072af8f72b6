"""Two fingers press a bar with 15 N, 30 mm beside its centre of mass, by SolverMuJoCo: twice its limit."""

import newton

newton.solvers.SolverMuJoCo.register_custom_attributes(builder := newton.ModelBuilder())
builder.add_mjcf("""<mujoco><option gravity="0 0 0"/><default><geom friction=".6 .005 0" condim="4" size=".02"/></default><worldbody>
  <geom pos="-.05 .03 0"/><body><freejoint/><inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/><geom type="box" size=".03 .1 .02"/>
  </body><body pos=".05 .03 0"><joint type="slide" axis="1 0 0"/><geom density="3000"/></body></worldbody></mujoco>""")
for cone in "elliptic", "pyramidal":
    solver = newton.solvers.SolverMuJoCo(model := builder.finalize(device="cpu"), cone=cone)
    old, new, contacts = model.state(), model.state(), model.contacts()
    for k in range(700):
        old.body_f.assign([[0, 0, -0.2 * 9.81 * (k >= 500), 0, 0, 0], [-15, 0, 0, 0, 0, 0]])
        solver.step(old, new, model.control(), contacts, 0.001)
        old, new = new, old
    print(f"{cone}: {2 * old.body_q.numpy()[0, 3]:.3g} rad in 0.2 s (Coulomb: 0)")
