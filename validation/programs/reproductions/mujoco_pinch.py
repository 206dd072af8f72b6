"""Two fingers press a bar with 15 N, 30 mm beside its centre of mass; 7.5 N hold it by any cone. How far it turns in 0.2 s."""

import mujoco

for option in 'cone="pyramidal"', 'cone="pyramidal" noslip_iterations="3"', 'cone="elliptic"', 'cone="elliptic" impratio="100"':
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".02" condim="4" friction=".6 .005 .0001"/>
      </default><option timestep=".001" gravity="0 0 0" {option}/><worldbody><geom pos="-.05 .03 0"/>
      <body><freejoint/><inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/>
      <geom type="box" size=".03 .1 .02"/></body><body pos=".05 .03 0"><joint type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass=".1" diaginertia="1e-4 1e-4 1e-4"/><geom/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    data.xfrc_applied[2, 0] = -15
    mujoco.mj_step(model, data, 500)  # grips
    data.xfrc_applied[1, 2] = -0.2 * 9.81
    mujoco.mj_step(model, data, 200)
    print(f"{option}: {2 * data.qpos[4]:.3g} rad (Coulomb: 0)")
