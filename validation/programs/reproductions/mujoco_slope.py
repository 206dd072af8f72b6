"""A sled on a slope of tangent 0.45, mu = 0.5: the speed of its creep from 0.26 to 0.5 s on the slope."""

import math

import mujoco

for option in 'cone="pyramidal"', 'cone="pyramidal" noslip_iterations="3"', 'cone="elliptic"', 'cone="elliptic" impratio="100"':
    feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".01" condim="4" friction=".5 .01 .0001"/>
      </default><option timestep=".001" {option}/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .02">
      <freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)  # settles on the level
    model.opt.gravity = 9.81 * math.sin(math.atan(0.45)), 0, -9.81 * math.cos(math.atan(0.45))
    mujoco.mj_step(model, data, 260)
    x = data.qpos[0]
    mujoco.mj_step(model, data, 240)
    print(f"{option}: {1e6 * (data.qpos[0] - x) / 0.24:.3g} um/s (Coulomb: 0)")
