"""Two fingers press a bar with 15 N, 30 mm beside its centre of mass; 7.5 N hold it by any cone. How far it turns in 0.2 s."""

import newton

newton.solvers.SolverMuJoCo.register_custom_attributes(builder := newton.ModelBuilder(gravity=(0, 0, 0)))
builder.add_mjcf("""<mujoco><default><geom friction=".6 .005 0" condim="4" size=".02"/></default><worldbody>
  <geom pos="-.05 .03 0"/><body><freejoint/><inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/><geom type="box" size=".03 .1 .02"/></body>
  <body pos=".05 .03 0"><joint type="slide" axis="1 0 0"/><geom/><inertial pos="0 0 0" mass=".1" diaginertia="1e-4 1e-4 1e-4"/></body></worldbody></mujoco>""")
twenty = {"iterations": 20}
unweighted = {"iterations": 20, "rigid_contact_con_weighting": False}
for name, options in ("XPBD", {}), ("XPBD, iterations 20", twenty), ("XPBD, iterations 20, unweighted", unweighted), ("MuJoCo (mujoco-warp), elliptic, condim 4", {"cone": "elliptic"}):
    solver = getattr(newton.solvers, "Solver" + name.replace(",", "").split()[0])(model := builder.finalize(device="cpu"), **options)
    old = model.state()
    new = model.state()
    contacts = (pipeline := newton.CollisionPipeline(model)).contacts()
    turn = []
    for k in range(700):
        old.body_f.assign([[0, 0, -0.2 * 9.81 * (k >= 500), 0, 0, 0], [-15, 0, 0, 0, 0, 0]])  # the bar's weight, after 0.5 s
        solver.step(old, new, model.control(), pipeline.collide(old, contacts) or contacts, 0.001)
        turn, old, new = [*turn, 2 * new.body_q.numpy()[0, 3]], new, old
    print(f"{name}: {turn[699] - turn[499]:.3g} rad (Coulomb: 0)")
