"""A ball under 0.99 of the torque about the normal that torsional friction holds."""

import mujoco

for cone, ratio, noslip in ("pyramidal", 1, 3), ("elliptic", 1, 0), ("elliptic", 100, 0):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".05" condim="4"
      friction=".5 .01 .0001"/></default><option timestep=".001" cone="{cone}" impratio="{ratio}"
      noslip_iterations="{noslip}"/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .05">
      <freejoint/><inertial pos="0 0 0" mass=".3" diaginertia="3e-4 3e-4 3e-4"/><geom/></body>
      </worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    data.xfrc_applied[1, 5] = 0.99 * 0.01 * 0.3 * 9.81
    mujoco.mj_step(model, data, 500)
    print(f"{cone}, {ratio}, {noslip}: {data.qvel[5]:.3g} rad/s (Coulomb: 0)")
