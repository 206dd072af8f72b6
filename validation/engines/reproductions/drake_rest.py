"""A ball let fall from 1 mm, by SAP with steps of 1 ms: its speed and height while it rests."""

import pydrake.all as d

config = d.MultibodyPlantConfig(time_step=0.001, discrete_contact_approximation="sap")
plant, _ = d.AddMultibodyPlant(config, builder := d.DiagramBuilder())
d.Parser(plant).AddModelsFromString("""<mujoco model="m"><worldbody><geom type="plane" size="1 1 1"/>
  <body name="ball" pos="0 0 .051"><inertial mass=".3" pos="0 0 0" diaginertia="3e-4 3e-4 3e-4"/>
  <freejoint/><geom size=".05"/></body></worldbody></mujoco>""", "xml")
plant.Finalize()
simulator = d.Simulator(builder.Build())
context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
for time in 0.25, 0.5, 1.0, 2.0:
    simulator.AdvanceTo(time)
    speed, z = plant.GetVelocities(context)[5], plant.GetPositions(context)[6]
    print(f"{time} s: {1e6 * speed:.3g} um/s, {1e6 * (z - 0.05):.4g} um (rigid bodies: 0, 0)")
