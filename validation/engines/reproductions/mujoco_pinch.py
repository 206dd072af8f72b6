"""Two fingers press a bar with 15 N, 30 mm beside its centre of mass: each cone's limit, twice."""

import mujoco

for cone, ratio, noslip in ("pyramidal", 1, 3), ("elliptic", 1, 0), ("elliptic", 100, 0):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".02" condim="4"
      friction=".6 .005 .0001"/></default><option timestep=".001" gravity="0 0 0" cone="{cone}"
      impratio="{ratio}" noslip_iterations="{noslip}"/><worldbody><geom pos="-.05 .03 0"/>
      <body><freejoint/><inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/>
      <geom type="box" size=".03 .1 .02"/></body><body pos=".05 .03 0"><joint type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass=".1" diaginertia="1e-4 1e-4 1e-4"/><geom/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    data.xfrc_applied[2, 0] = -15
    mujoco.mj_step(model, data, 500)
    data.xfrc_applied[1, 2] = -0.2 * 9.81
    mujoco.mj_step(model, data, 200)
    print(f"{cone}, {ratio}, {noslip}: turns by {2 * data.qpos[4]:.3g} rad (Coulomb: 0)")
