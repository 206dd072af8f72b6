"""A sled that slides down a slope of tangent 1, mu = 0.5: how far it rises, over the slip of a step."""

import mujoco

noslip = ' noslip_iterations="3"'
for option in 'cone="pyramidal"', 'cone="pyramidal"' + noslip, 'cone="elliptic"', 'cone="elliptic" impratio="100"', 'cone="elliptic"' + noslip:
    feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".01" condim="4" friction=".5 .01 .0001"/>
      </default><option timestep=".001" {option}/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .02">
      <freejoint/>{feet}<inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)  # settles on the level
    model.opt.gravity = 9.81 * 0.5**0.5, 0, -9.81 * 0.5**0.5
    mujoco.mj_step(model, data, 500)
    print(f"{option}: {(data.qpos[2] - 0.02) / (0.001 * data.qvel[0]):.3g} of the slip of a step (Coulomb: 0)")
