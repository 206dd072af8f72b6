"""A ball under 0.99 of the torque about the normal that friction holds: its rate of turning, after 0.5 s."""

import newton

newton.solvers.SolverMuJoCo.register_custom_attributes(builder := newton.ModelBuilder())
builder.add_mjcf("""<mujoco><default><geom friction=".5 .01 0" size=".05" condim="4"/></default><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 .05"><freejoint/><geom/><inertial pos="0 0 0" mass=".3" diaginertia="3e-4 3e-4 3e-4"/></body></worldbody></mujoco>""")
for name, options in ("XPBD", {}), ("MuJoCo (mujoco-warp), elliptic, condim 4", {"cone": "elliptic"}):
    solver = getattr(newton.solvers, "Solver" + name.split()[0])(model := builder.finalize(device="cpu"), **options)
    old = model.state()
    new = model.state()
    contacts = (pipeline := newton.CollisionPipeline(model)).contacts()
    for k in range(1000):
        old.body_f.assign([[0, 0, 0, 0, 0, 0.99 * 0.01 * 0.3 * 9.81 * (k >= 500)]])
        solver.step(old, new, model.control(), pipeline.collide(old, contacts) or contacts, 0.001)
        old, new = new, old
    print(f"{name}: {old.body_qd.numpy()[0, 5]:.3g} rad/s (Coulomb: 0)")
