"""A sled under 0.9 of the force that friction holds; 1 um/s is a millimetre in 17 minutes."""

import mujoco

for cone, ratio, noslip in ("pyramidal", 1, 3), ("elliptic", 1, 0), ("elliptic", 100, 0):
    feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".01" condim="4"
      friction=".5 .01 .0001"/></default><option timestep=".001" cone="{cone}" impratio="{ratio}"
      noslip_iterations="{noslip}"/><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .02">
      <freejoint/><inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/>{feet}</body>
      </worldbody></mujoco>""")
    data = mujoco.MjData(model)
    data.xfrc_applied[1, 0] = 0.9 * 0.5 * 0.3 * 9.81
    mujoco.mj_step(model, data, 1000)
    print(f"{cone}, {ratio}, {noslip}: {1e6 * data.qvel[0]:.3g} um/s (Coulomb: 0)")
