"""A sled under the load of a slope of tangent 0.45, mu = 0.5: the speed at which it creeps, from its places at 0.76 and 1 s."""

import newton

feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
builder = newton.ModelBuilder()
builder.add_mjcf(f"""<mujoco><default><geom friction=".5 .01 0" size=".01"/></default><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 .02"><freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
builder.color()
for name, options in ("XPBD", {}), ("XPBD, iterations 20", {"iterations": 20}), ("VBD", {}):
    solver = getattr(newton.solvers, "Solver" + name.split(",")[0])(model := builder.finalize(device="cpu"), **options)
    old = model.state()
    new = model.state()
    contacts = (pipeline := newton.CollisionPipeline(model)).contacts()
    x = []
    for k in range(1000):
        old.body_f.assign([[1.2077 * (k >= 500), 0, 0.25922 * (k >= 500), 0, 0, 0]])  # 0.3 9.81 (sin a, 0, 1 - cos a)
        solver.step(old, new, model.control(), pipeline.collide(old, contacts) or contacts, 0.001)
        x, old, new = [*x, new.body_q.numpy()[0, 0]], new, old
    print(f"{name}: {1e6 * (x[999] - x[759]) / 0.24:.4g} um/s (Coulomb: 0)")
