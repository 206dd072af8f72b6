"""A sled pulled by 0.8 m g, mu = 0.5: how it accelerates, and rises over the slip of a step."""

import mujoco

for cone, way in ("pyramidal", (1, 0)), ("pyramidal", (0.5**0.5, 0.5**0.5)), ("elliptic", (1, 0)):
    feet = "".join(f'<geom pos="{x} {y} -.01"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom size=".01" condim="4"
      friction=".5 .01 .0001"/></default><option timestep=".001" cone="{cone}"/><worldbody>
      <geom type="plane" size="1 1 1"/><body pos="0 0 .02"><freejoint/>{feet}
      <inertial pos="0 0 0" mass=".3" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    data.xfrc_applied[1, :2] = 0.8 * 0.3 * 9.81 * way[0], 0.8 * 0.3 * 9.81 * way[1]
    mujoco.mj_step(model, data, 500)
    speed = (data.qvel[0] ** 2 + data.qvel[1] ** 2) ** 0.5
    rise = (data.qpos[2] - 0.02) / (0.001 * speed)
    print(f"{cone} {way}: {speed / 0.5:.3f} m/s^2 (Coulomb: 2.943), rise {rise:.3f} (Coulomb: 0)")
