"""A sled under the load of slopes of tangent 0.45 and 1, mu = 0.5, by SolverMuJoCo: its creep on the first, its largest rise (seen every 20 ms) on the second."""

import math

import newton

feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
newton.solvers.SolverMuJoCo.register_custom_attributes(builder := newton.ModelBuilder())
builder.add_mjcf(f"""<mujoco><default><geom friction=".5 .01 0" size=".01" condim="4"/></default><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 .02"><freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
for a in math.atan(0.45), math.atan(1):
    solver = newton.solvers.SolverMuJoCo(model := builder.finalize(device="cpu"), cone="elliptic")
    old = model.state()
    new = model.state()
    contacts = model.contacts()
    x = []
    for k in range(1000):
        old.body_f.assign([[0.3 * 9.81 * math.sin(a) * (k >= 500), 0, 0.3 * 9.81 * (1 - math.cos(a)) * (k >= 500), 0, 0, 0]])
        solver.step(old, new, model.control(), contacts, 0.001)
        x, old, new = [*x, new.body_q.numpy()[0].tolist()], new, old
    v = (x[999][0] - x[759][0]) / 0.24
    print(f"MuJoCo (mujoco-warp), elliptic, condim 4: {1e6 * v:.4g} um/s, {max(p[2] - 0.02 for p in x[499::20]) / (x[999][0] - x[998][0]):.3g} of the slip of a step above the floor")
