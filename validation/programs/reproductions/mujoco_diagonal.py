"""A sled slides down a slope of tangent 1, along the diagonal of its pyramid, mu = 0.5: the slope at which friction would hold."""

import math

import mujoco

for option in 'cone="pyramidal"', 'cone="pyramidal" noslip_iterations="3"':
    feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".01" condim="4" friction=".5 .01 .0001"/>
      </default><option timestep=".001" {option}/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .02">
      <freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)  # settles on the level
    model.opt.gravity = 9.81 / 2, 9.81 / 2, -9.81 * 0.5**0.5
    mujoco.mj_step(model, data, 500)
    mu = 1 - math.hypot(*data.qvel[:2]) / 0.5 / (9.81 * 0.5**0.5)  # speed = 0.5 s (1 - mu) g / sqrt 2
    print(f"{option}: {math.degrees(math.atan(mu)):.3g} deg (Coulomb: 26.6)")
