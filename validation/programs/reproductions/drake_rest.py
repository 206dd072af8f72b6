"""A ball let fall from 1 mm, by SAP with steps of 1 ms: its mean speed in the second half of a second."""

import pydrake.all as d

plant, _ = d.AddMultibodyPlant(d.MultibodyPlantConfig(time_step=0.001, discrete_contact_approximation="sap"), builder := d.DiagramBuilder())
d.Parser(plant).AddModelsFromString("""<mujoco model="m"><worldbody><geom type="plane" size="1 1 1" friction=".5"/>
  <body name="ball" pos="0 0 .051"><inertial mass=".3" pos="0 0 0" diaginertia="3e-4 3e-4 3e-4"/>
  <freejoint/><geom size=".05" friction=".5"/></body></worldbody></mujoco>""", "xml")
plant.Finalize()
simulator = d.Simulator(builder.Build())
context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
z = []
for time in 0.5, 1.0:
    simulator.AdvanceTo(time)
    z.append(plant.GetPositions(context)[6])
print(f"point, sap: {1e6 * (z[0] - z[1]) / 0.5:.3g} um/s downwards (rigid bodies: 0)")
