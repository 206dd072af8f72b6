"""A sled under 0.9 of the force that friction holds: its mean speed over half a second, by its places."""

import newton

feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
builder = newton.ModelBuilder()
builder.add_mjcf(f"""<mujoco><default><geom friction=".5 .01 0" size=".01"/></default><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 .02"><freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
builder.color()
for name, options in ("XPBD", {}), ("XPBD", {"iterations": 20}), ("VBD", {}):
    solver = getattr(newton.solvers, "Solver" + name)(model := builder.finalize(device="cpu"), **options)
    old, new, contacts, x = model.state(), model.state(), model.contacts(), []
    for k in range(1500):
        old.body_f.assign([[0.9 * 0.5 * 0.3 * 9.81 * (k >= 500), 0, 0, 0, 0, 0]])
        solver.step(old, new, model.control(), model.collide(old, contacts) or contacts, 0.001)
        x, old, new = [*x, new.body_q.numpy()[0, 0]], new, old
    print(f"{name} {options}: {2e6 * (x[-1] - x[-501]):.3g} um/s (Coulomb: 0)")
