"""A ball under 0.99 of the torque about the normal that torsional friction holds: its rate of turning."""

import mujoco

for option in 'cone="pyramidal"', 'cone="pyramidal" noslip_iterations="3"', 'cone="elliptic"', 'cone="elliptic" impratio="100"':
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".05" condim="4" friction=".5 .01 .0001"/>
      </default><option timestep=".001" {option}/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .05">
      <freejoint/><geom/><inertial pos="0 0 0" mass=".3" diaginertia="3e-4 3e-4 3e-4"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)  # settles
    data.xfrc_applied[1, 5] = 0.99 * 0.01 * 0.3 * 9.81
    mujoco.mj_step(model, data, 500)
    print(f"{option}: {data.qvel[5]:.3g} rad/s (Coulomb: 0)")
